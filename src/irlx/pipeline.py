"""Where the stages meet: program and cell -> blocks -> paced motion -> joint stream."""

from __future__ import annotations

import os
from collections.abc import Generator, Iterator, Sequence
from contextlib import closing
from dataclasses import replace
from math import radians

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.blocks import AskPause, AskStandstill, Block, LinkFrame, Origin, Question
from irlx.cell.link_meshes import resolved_solids
from irlx.cell.setting import setting_of
from irlx.diagnostics import Diagnostic, IrlxError, Place, report
from irlx.diagnostics.fault import fault
from irlx.interpreter.called import Called
from irlx.interpreter.channels.channels import Channels, Told
from irlx.interpreter.interpret import Interpretation
from irlx.job import Job, header_of, kinematics_of
from irlx.one_thread import worked_out_on_one_thread
from irlx.pacing.correction.corrector import CorrectedRow, Corrector, Senses
from irlx.pacing.correction.nearness import Nearness
from irlx.pacing.correction.tally import Tally
from irlx.pacing.correction.tool_rates import ToolRates
from irlx.pacing.executed import Executed
from irlx.pacing.explanation import TickExplanation
from irlx.pacing.explanation import explain_tick as explain_row
from irlx.pacing.frames import frame_of, seen_from
from irlx.pacing.lookahead import Lookahead
from irlx.pacing.notes import Notes
from irlx.pacing.pacer import Pacer
from irlx.pacing.pauses import PauseAborted
from irlx.pacing.resolution import EVERY_TICK, Resolution
from irlx.pacing.situation import PacingSetup
from irlx.pacing.watch import Watch
from irlx.recorded import Recorded
from irlx.scene.sightings import Sightings
from irlx.solids.mesh_file import MeshFileError
from irlx.streams.atomic import AtomicFile
from irlx.streams.joint_stream import StreamHeader

Array = NDArray[np.float64]


class Execution:
    """One run in progress: a program's blocks, and the pacer that executes them.

    `channels` are what it reads and writes; `left_open` warns of files that were open at its end; `watch` is
    told what is being worked on.
    """

    def __init__(
        self,
        job: Job,
        resolution: Resolution = EVERY_TICK,
        planned_share: float = 1.0,
        sightings: Sightings | None = None,
        watch: Watch | None = None,
    ) -> None:
        self.job = job
        cell = job.cell
        dt = job.tick_ns / 1e9
        setup = PacingSetup(
            kinematics_of(cell),
            cell.limits,
            cell.weights,
            cell.start,
            dt,
            max_slow=job.max_slow,
            inputs=job.inputs,
            resolution=resolution,
            planned_share=planned_share,
            scene=replace(cell.scene, sightings=sightings),
            may_free=job.program.has_tolerances,
            watch=watch,
        )
        self.kinematics = setup.kinematics
        self._pacer = Pacer(setup, self._locate)
        self._interpretation: Interpretation | None = None
        self._called = Called()
        self.left_open: list[Diagnostic] = []
        self.channels = job.channels.on_disk()

    def __iter__(self) -> Iterator[Executed]:
        """Execute the program block by block. Raises IrlxError where it cannot go on (IRL090: by a fault)."""
        with closing(self._carried_out()) as source:
            yield from self._executed(worked_out_on_one_thread(source))

    def _executed(self, source: Iterator[Executed]) -> Iterator[Executed]:
        while True:
            try:
                executed = next(source)
            except StopIteration:
                return
            except IrlxError:
                raise
            except PauseAborted as aborted:
                raise aborted.error from None
            except Exception as error:
                if isinstance(error, MeshFileError):
                    # Where that is a file of the robot's links, all such files at fault are told.
                    resolved_solids(self.job.cell.robot, self.job.cell.model, self.job.cell.file)
                if os.environ.get("IRLX_DEBUG"):
                    raise
                # A fault of irlx itself must not cost what was executed before it.
                raise IrlxError(fault(error)) from error
            yield executed

    def _carried_out(self) -> Generator[Executed, None, None]:
        """What becomes of the blocks; the program runs ahead of them while its moves pass their targets."""
        scene = self._pacer.setup.scene
        moving = scene.moves or scene.sightings is not None
        ahead = Lookahead(self._locate, self._pacer.notes, obstacles_move=moving)
        source, reply = self._interpreted(self.channels), None
        with closing(source):
            while True:
                try:
                    item = source.send(reply)
                except StopIteration:
                    yield from self._all(ahead.stop(None, "the program ends"))
                    return
                except IrlxError:
                    yield from self._all(ahead.stop(None, "the program cannot go on"))
                    raise
                reply = None
                if isinstance(item, Question):
                    yield from self._all(ahead.before(item))
                    reply = self._answer(item)
                else:
                    self._called.take(item, self._calls)
                    yield from self._all(ahead.take(item))

    @property
    def _calls(self) -> tuple[Place, ...]:
        """Where the routines that are under way were called."""
        return () if self._interpretation is None else self._interpretation.calls

    def _all(self, groups: Sequence[tuple[Block, ...]]) -> Iterator[Executed]:
        for group in groups:
            try:
                yield from self._pacer.carry_out(group)
            except IrlxError as error:
                self._called.tell(error, group, self._locate)
                raise

    def corrected(self, senses: Senses, tally: Tally, nearness: Nearness) -> Iterator[CorrectedRow]:
        """Rows of the program, each followed as `senses` say to the one before; see `planned_share`."""
        motion = self.job.cell.motion
        rates = ToolRates(
            motion.speed / 1e3, motion.acc / 1e3, radians(motion.speed_ori), radians(motion.acc_ori)
        )
        return worked_out_on_one_thread(Corrector(self._pacer, rates, senses, tally, nearness).rows(self))

    def blocks(self, told: Told | None = None) -> Iterator[Block]:
        """Blocks of the program; nothing moves until it asks for the posture that its moves lead to.

        Files are written in memory only; `told` is called with what is written.
        """
        self.channels = self.job.channels.in_memory(told)
        waiting: list[Block] = []
        source, reply = self._interpreted(self.channels), None
        while True:
            try:
                item = source.send(reply)
            except StopIteration:
                return
            reply = None
            if isinstance(item, AskPause | AskStandstill):
                reply = self._answer(item)
            elif isinstance(item, Question):
                self._move_to_the_end_of(waiting)
                waiting.clear()
                reply = self._answer(item)
            else:
                yield item
                waiting.append(item)

    def _answer(self, question: Question) -> tuple[float, ...]:
        """What the operator says to a pause, the machine to all else."""
        if isinstance(question, AskPause):
            return self.job.pauses.answer(question, self._locate)
        if isinstance(question, AskStandstill):
            return ()
        return self._pacer.answer(question)

    def _move_to_the_end_of(self, blocks: Sequence[Block]) -> None:
        """Carry out blocks for their effect on where the robot stands."""
        ahead = Lookahead(self._locate, Notes([]))
        groups = [group for block in blocks for group in ahead.take(block)]
        for _ in self._all([*groups, *ahead.stop(None, "")]):
            pass

    def _interpreted(self, channels: Channels) -> Generator[Block | Question, tuple[float, ...] | None, None]:
        """The program under way: its blocks and questions; then its files are closed."""
        try:
            yield from self._program(channels)
            self.left_open = channels.finish()
        finally:
            channels.finish()
        lost = [found for found in self.left_open if found.is_error]
        if lost:
            raise IrlxError(lost)

    def _program(self, channels: Channels) -> Generator[Block | Question, tuple[float, ...] | None, None]:
        job, program = self.job, self.job.program
        if isinstance(program, Recorded):
            return program.replayed(job.inputs, job.cell)
        setting = setting_of(job.cell)
        ready = Interpretation(
            program.tree,
            program.source,
            setting,
            program.data_lists,
            program.modules,
            job.max_steps,
            channels,
        )
        self._interpretation = ready
        return ready.run()

    def write_data(self) -> list[Diagnostic]:
        """Write values that the program changed back to its data lists, each file whole or not at all.

        Returns warnings, IRL264. Raises IrlxError, IRL265, for a file that is not as it was read; IRL003
        for one that cannot be written. Lists before it are written then.
        """
        warnings: list[Diagnostic] = []
        if self._interpretation is None:
            return warnings
        for found in self.job.program.all_lists:
            new = self._interpretation.rewritten(found)
            warnings += new.warnings
            if new.text != found.source.text:
                if not found.is_as_read():
                    raise IrlxError(report("IRL265", Place(str(found.path)), path=found.path))
                with AtomicFile(found.path) as file:
                    file.write(new.text.encode("utf-8"))
        return warnings

    def explain(self, executed: Executed, before: Array, tick: int) -> TickExplanation | None:
        """Explanation of a tick, None where it is no row of this block; `before` (2, n): the rows before."""
        rows = executed.rows
        if rows is None or not rows.first_tick <= tick < rows.first_tick + len(rows):
            return None
        cell = self.job.cell
        limits, setup = rows.limits or cell.limits, self._pacer.setup
        dt = self.job.tick_ns / 1e9
        place = self._pacer.locate(rows.block.origin)
        kinematics = seen_from(setup.kinematics, frame_of(rows.block), place)
        return explain_row(rows, before, tick, limits, setup.weights, kinematics, dt)

    def tool_in(self, frame: LinkFrame, q: Array) -> Array:
        """Position (m) and quaternion, (7,), of the tool in posture q (n,), as a frame of a link sees it."""
        rotation, position = self._pacer.setup.kinematics.relative_to(frame).tool_pose(q)
        return np.concatenate([position, Rotation.from_matrix(rotation).as_quat()])

    def start(self) -> tuple[StreamHeader, Array, Array, Array]:
        """Header of the stream; start posture (n,), and the tool's rotation (3, 3), position (3,) m in it."""
        start = self.job.cell.start
        return header_of(self.job), start, *self.kinematics.tool_pose(start)

    @property
    def warnings(self) -> list[Diagnostic]:
        """Warnings of the blocks executed so far."""
        own = self._interpretation.warnings if self._interpretation is not None else []
        left = (found for found in self.left_open if not found.is_error)
        return [*own, *self._pacer.warnings, *left]

    def _locate(self, origin: Origin) -> Place:
        return self.job.program.place(origin)
