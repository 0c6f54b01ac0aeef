"""Where the stages meet: program and cell -> blocks -> paced motion -> joint stream."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import replace
from math import radians
from pathlib import PurePath
from typing import IO

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import AskPause, AskStandstill, Block, Origin, Question
from irlx.cell.setting import setting_of
from irlx.diagnostics import Diagnostic, IrlxError, Place, Span, report
from irlx.interpreter.channels.channels import Channels, Told
from irlx.interpreter.channels.pieces import InputGiven
from irlx.interpreter.interpret import Interpretation
from irlx.job import InputsGiven, Job, PathLike, header_of, kinematics_of, prepare
from irlx.language.suppression import without_ignored
from irlx.pacing.correction.corrector import CorrectedRow, Corrector, Senses
from irlx.pacing.correction.nearness import Nearness
from irlx.pacing.correction.share import CORRECTION_SHARE
from irlx.pacing.correction.tally import Tally
from irlx.pacing.correction.tool_rates import ToolRates
from irlx.pacing.executed import Executed
from irlx.pacing.explanation import TickExplanation
from irlx.pacing.explanation import explain_tick as explain_row
from irlx.pacing.lookahead import Lookahead
from irlx.pacing.notes import Notes
from irlx.pacing.pacer import Pacer
from irlx.pacing.pauses import PauseAborted, PauseFunction
from irlx.pacing.resolution import EVERY_TICK, Resolution
from irlx.pacing.situation import PacingSetup
from irlx.program import Program
from irlx.report.recording import Recording
from irlx.report.run import Run, RunError, RunInterrupted
from irlx.scene.sightings import Sightings
from irlx.streams.atomic import AtomicFile
from irlx.streams.sample import Sample
from irlx.streams.sample_stream import SampleStream
from irlx.streams.sampler import Sampler

Array = NDArray[np.float64]
Progress = Callable[[Block, float], None]
"""Called after each block with the block and the simulated time so far, s."""

Sensor = Callable[[Sample], Sequence[float] | Array | None]
"""Called with the last sample; gives the correction that the tool is to have, None to leave it."""

Watcher = Callable[[Sample], Mapping[str, Sequence[float] | Array | None] | None]
"""Called with the last sample; gives poses of obstacles by name, None to leave them where they are."""


class Execution:
    """One run in progress: a program's blocks, and the pacer that executes them.

    `channels` are what it reads and writes; `left_open` warns of files that were open at its end.
    """

    def __init__(
        self,
        job: Job,
        resolution: Resolution = EVERY_TICK,
        planned_share: float = 1.0,
        sightings: Sightings | None = None,
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
        )
        self.kinematics = setup.kinematics
        self._pacer = Pacer(setup, self._locate)
        texts = (job.program.source, *(module.source for module in job.program.modules))
        self._interpretation: Interpretation | None = None
        self.left_open: list[Diagnostic] = []
        self.channels = job.channels.on_disk()
        self._texts = {PurePath(text.name).name: text for text in texts}

    def __iter__(self) -> Iterator[Executed]:
        """Execute the program block by block. Raises IrlxError where it cannot go on (IRL090: by a fault)."""
        with closing(self._carried_out()) as source:
            yield from self._executed(source)

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
                if os.environ.get("IRLX_DEBUG"):
                    raise
                # A fault of irlx itself must not cost what was executed before it.
                raise IrlxError(report("IRL090", cause=f"{type(error).__name__}: {error}")) from error
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
                    yield from self._all(ahead.take(item))

    def _all(self, groups: Sequence[tuple[Block, ...]]) -> Iterator[Executed]:
        for group in groups:
            yield from self._pacer.carry_out(group)

    def corrected(self, senses: Senses, tally: Tally, nearness: Nearness) -> Iterator[CorrectedRow]:
        """Rows of the program, each followed as `senses` say to the one before; see `planned_share`."""
        motion = self.job.cell.motion
        rates = ToolRates(
            motion.speed / 1e3, motion.acc / 1e3, radians(motion.speed_ori), radians(motion.acc_ori)
        )
        return Corrector(self._pacer, rates, senses, tally, nearness).rows(self)

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
        return explain_row(rows, before, tick, limits, setup.weights, setup.kinematics, dt)

    def recording(self) -> Recording:
        """A recording that begins at the cell's start posture."""
        start = self.job.cell.start
        return Recording(header_of(self.job), start, *self.kinematics.tool_pose(start))

    @property
    def warnings(self) -> list[Diagnostic]:
        """Warnings of the blocks executed so far."""
        own = self._interpretation.warnings if self._interpretation is not None else []
        left = (found for found in self.left_open if not found.is_error)
        return [*own, *self._pacer.warnings, *left]

    def _locate(self, origin: Origin) -> Place:
        text = self._texts.get(origin.file, self.job.program.source)
        return Place.in_text(text, Span(origin.start, origin.end))


def run(
    program: Program | PathLike,
    cell: PathLike | None = None,
    tick_ms: float | None = None,
    progress: Progress | None = None,
    explain_tick: int | None = None,
    max_slow: float | None = None,
    max_steps: int | None = None,
    inputs: InputsGiven = None,
    write_data: bool = False,
    files: PathLike | None = None,
    input: InputGiven = None,
    output: IO[str] | None = None,
    pause_s: float = 0.0,
) -> Run:
    """Interpret a program, move its robot, and return the joint stream.

    `cell`: path of the cell file, by default found beside the program; `tick_ms` overrides the
    cell's tick; `explain_tick` asks for `Run.explanation` of that tick; a move that limits make
    more than `max_slow` times as long as programmed is an error, and so are more than `max_steps`
    statements (by default 10,000,000); `inputs` as `InputsGiven`, in place of the cell's; each PAUSE lasts
    `pause_s` s, rounded up to whole ticks. With `write_data`, values of data lists that the program has
    changed are written to their files after a complete run.
    `files`: the folder that OPEN finds and makes files in, by default that of the program; `input`: what
    STANDARD_IN reads, a text or a file that is open; `output`: what gets the text for STANDARD_OUT while it
    is written, for instance sys.stdout, beside `Run.output`.
    Raises ProgramError and CellError before anything moves, RunError (with what was executed until then)
    once it does, RunInterrupted on Ctrl-C.
    """
    channels = files, input, output
    job = prepare(program, cell, tick_ms, max_slow, max_steps, inputs, *channels, pause_s)
    execution = Execution(job)
    finished = execute(execution, progress, explain_tick)
    if not write_data:
        return finished
    return replace(finished, diagnostics=(*finished.diagnostics, *execution.write_data()))


def execute(execution: Execution, progress: Progress | None = None, explain_tick: int | None = None) -> Run:
    """Run a prepared job to its end; see `run`."""
    recording = execution.recording()
    explanation: TickExplanation | None = None
    try:
        for executed in execution:
            if explain_tick is not None and explanation is None:
                explanation = execution.explain(executed, recording.last_postures, explain_tick)
            recording.add(executed)
            if progress is not None:
                progress(executed.block, recording.duration)
    except IrlxError as error:
        known = _told(execution)
        partial = recording.finish(False, (*known, *error.diagnostics))
        partial = replace(partial, explanation=explanation, output=execution.channels.output)
        raise RunError((*error.diagnostics, *known), partial) from error
    except KeyboardInterrupt as interrupt:
        partial = recording.finish(False, _told(execution))
        raise RunInterrupted(replace(partial, output=execution.channels.output)) from interrupt
    finished = recording.finish(True, _told(execution))
    return replace(finished, explanation=explanation, output=execution.channels.output)


def _told(execution: Execution) -> tuple[Diagnostic, ...]:
    """Warnings of a run so far, but those of its motion that comments of the program ask to ignore."""
    program, cell = execution.job.program, execution.job.cell
    kept, _ = without_ignored(execution.warnings, program.ignores)
    return (*program.diagnostics, *cell.warnings, *kept)


def stream(
    program: Program | PathLike,
    cell: PathLike | None = None,
    tick_ms: float | None = None,
    max_slow: float | None = None,
    max_steps: int | None = None,
    inputs: InputsGiven = None,
    files: PathLike | None = None,
    input: InputGiven = None,
    output: IO[str] | None = None,
    pause_s: float = 0.0,
    on_pause: PauseFunction | None = None,
    correct: Sensor | None = None,
    obstacles: Watcher | None = None,
) -> SampleStream:
    """Samples of a run, one after another, motion by motion as they are asked for.

    The same samples as `run` gives. Iteration may stop at any sample. At each PAUSE, all samples before it
    handed out, `on_pause` is called with its place; the program goes on when it returns, after the time, s,
    that it returns, or `pause_s` for None; what it raises comes out here. What cannot be prepared raises
    here, what goes wrong in motion at the sample it keeps from coming, as IrlxError.

    `correct` is asked after each sample for the correction of the tool in the next one: six numbers, the
    displacement (m) and the rotation vector (rad) from the programmed pose in its own frame, or None for no
    change. Motions are then planned with three quarters of the joints' speed and acceleration limits, and
    corrections follow within the rest; `SampleStream.corrections` reports what was delayed. Raises IrlxError
    with IRL583 for a cell with constraints, IRL006 for what is no function; at a sample IRL580, IRL581,
    IRL582 for an answer that is none, IRL584 for a correction for which new limits leave no room.

    `obstacles` is asked after each sample, and before a motion is planned, where obstacles of the cell are in
    the next one: a mapping from names to three numbers, the position (m) of the obstacle's frame in the
    world, or six, with its rotation vector (rad); None for as before. Where the program keeps clear of them,
    the posture makes room within the same part of the limits while the tool keeps its path; where it cannot,
    the margin gives way, which `SampleStream.obstacles` and a warning, IRL587, tell. Raises IrlxError at a
    sample: IRL585 for an answer that is none, IRL586 for names that the cell does not have.
    """
    channels = files, input, output
    job = prepare(program, cell, tick_ms, max_slow, max_steps, inputs, *channels, pause_s, on_pause)
    if correct is None and obstacles is None:
        execution = Execution(job)
        return SampleStream(_samples(execution), lambda: _told(execution))
    for option, given in (("correct=", correct), ("obstacles=", obstacles)):
        if given is not None and not callable(given):
            raise IrlxError(report("IRL006", option=option, value=repr(given), cause="a function"))
    sightings = None if obstacles is None else Sightings()
    execution = Execution(job, planned_share=1.0 - CORRECTION_SHARE, sightings=sightings)
    if execution.kinematics.constraints:
        names = ", ".join(one.name for one in execution.kinematics.constraints)
        raise IrlxError(report("IRL583", names=names))
    tally, nearness = Tally(job.cell.robot.joint_names), Nearness()
    return SampleStream(
        _followed(execution, correct, obstacles, tally, nearness),
        lambda: (*_told(execution), *nearness.warnings),
        lambda: tally.report,
        lambda: nearness.report,
    )


def _samples(execution: Execution) -> Generator[Sample, None, None]:
    recording = execution.recording()
    yield from recording.take_samples()
    for executed in execution:
        recording.add(executed)
        yield from recording.take_samples()


def _followed(
    execution: Execution, sensor: Sensor | None, watcher: Watcher | None, tally: Tally, nearness: Nearness
) -> Generator[Sample, None, None]:
    job = execution.job
    sampler, start = Sampler(job.tick_ns), job.cell.start
    senses = Senses(
        None if sensor is None else lambda: sensor(sampler.last),
        None if watcher is None else lambda: watcher(sampler.last),
    )
    yield sampler.sample(start, *execution.kinematics.tool_pose(start), 0, np.zeros(6))
    for row in execution.corrected(senses, tally, nearness):
        yield sampler.sample(row.q, row.rotation, row.position, row.block.id, row.correction, row.nearest)
