"""Where the stages meet: program and cell -> blocks -> paced motion -> joint stream."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import inf
from pathlib import Path, PurePath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from irlx._version import __version__
from irlx.blocks import Block, Origin, Question
from irlx.cell.cell import Cell
from irlx.cell.errors import CellError
from irlx.cell.find import is_file
from irlx.cell.input_file import read_input_file
from irlx.cell.load import load_cell
from irlx.cell.setting import setting_of
from irlx.diagnostics import Diagnostic, IrlxError, Place, Span, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.interpreter.interpret import MAX_STEPS, Interpretation
from irlx.pacing.executed import Executed
from irlx.pacing.explanation import TickExplanation
from irlx.pacing.explanation import explain_tick as explain_row
from irlx.pacing.inputs import InputFunction, Inputs
from irlx.pacing.lookahead import Lookahead
from irlx.pacing.notes import Notes
from irlx.pacing.pacer import Pacer
from irlx.pacing.resolution import EVERY_TICK, Resolution
from irlx.pacing.situation import PacingSetup
from irlx.program import Program, ProgramError, cell_path, load
from irlx.promises import CONDITION, LONGEST_TICK, SHORTEST_TICK
from irlx.report.recording import Recording
from irlx.report.run import Run, RunError, RunInterrupted
from irlx.robot.equality import Constraint, LinearConstraint
from irlx.robot.kinematics import Kinematics
from irlx.robot.registered_constraints import registered_constraints
from irlx.streams.atomic import AtomicFile
from irlx.streams.joint_stream import FORMAT_VERSION, StreamHeader
from irlx.streams.sample import Sample

Array = NDArray[np.float64]
PathLike = str | os.PathLike[str]
InputsGiven = InputFunction | Mapping[str, Sequence[tuple[float, float]]] | PathLike | None
"""A function of name and time (s), traces by name (times in s with the value from each on), or a CSV file."""

Progress = Callable[[Block, float], None]
"""Called after each block with the block and the simulated time so far, s."""

LEAST_TICK_MS = SHORTEST_TICK * 1e3
LONGEST_TICK_MS = LONGEST_TICK * 1e3


@dataclass(frozen=True)
class Job:
    """A program and the cell it runs in, checked against each other; tick in ns.

    A move may take `max_slow` times as long as programmed, the program may execute `max_steps` statements;
    `inputs` are the cell's with those of the caller.
    """

    program: Program
    cell: Cell
    tick_ns: int
    max_slow: float = inf
    max_steps: int = MAX_STEPS
    inputs: Inputs = field(default_factory=Inputs)


def prepare(
    program: Program | PathLike,
    cell: PathLike | None = None,
    tick_ms: float | None = None,
    max_slow: float | None = None,
    max_steps: int | None = None,
    inputs: InputsGiven = None,
) -> Job:
    """Load what a run needs.

    `cell` None: the file that SYSTEM SPECIFICATION names, else the program's own name with .toml.
    Raises ProgramError, CellError, or IrlxError with IRL006 for a number out of range.
    """
    if not isinstance(program, Program):
        program = _loaded(program, cell)
    loaded = load_cell(cell_path(program, cell))
    if max_slow is not None and not max_slow >= 1.0:
        cause = "a move cannot be faster than programmed: at least 1"
        raise IrlxError(report("IRL006", option="--max-slow", value=f"{max_slow:g}", cause=cause))
    slowest = inf if max_slow is None else max_slow
    said = inputs_of(loaded, inputs)
    steps = MAX_STEPS if max_steps is None else max_steps
    if steps < 1:
        raise IrlxError(report("IRL006", option="--max-steps", value=f"{steps}", cause="at least 1"))
    if tick_ms is None:
        return Job(program, loaded, loaded.tick_ns, slowest, steps, said)
    if not LEAST_TICK_MS <= tick_ms <= LONGEST_TICK_MS:
        cause = f"a tick lasts {LEAST_TICK_MS:g} to {LONGEST_TICK_MS:g} ms"
        raise IrlxError(report("IRL006", option="--tick", value=f"{tick_ms:g}", cause=cause))
    return Job(program, loaded, round(tick_ms * 1e6), slowest, steps, said)


def inputs_of(cell: Cell, given: InputsGiven) -> Inputs:
    """What inputs say: first `given`, a function, traces by name or the path of a CSV; else the cell.

    Raises CellError for a file that is no such CSV.
    """
    if callable(given):
        return Inputs(cell.inputs, given)
    if isinstance(given, str | os.PathLike):
        return Inputs({**cell.inputs, **read_input_file(Path(given))})
    own = {
        name.casefold(): tuple((float(at), float(value)) for at, value in trace)
        for name, trace in (given or {}).items()
    }
    return Inputs({**cell.inputs, **own})


def _loaded(path: PathLike, cell: PathLike | None) -> Program:
    """The program; where names are unknown and its cell is at fault, the cell's faults come first."""
    try:
        return load(path, cell)
    except ProgramError as error:
        likely = Path(cell) if cell is not None else Path(path).with_suffix(".toml")
        if any(found.code == "IRL201" for found in error.diagnostics) and is_file(likely):
            load_cell(likely)
        raise


class Execution:
    """One run in progress: a program's blocks, and the pacer that executes them."""

    def __init__(self, job: Job, resolution: Resolution = EVERY_TICK) -> None:
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
        )
        self.kinematics = setup.kinematics
        self._pacer = Pacer(setup, self._locate)
        texts = (job.program.source, *(module.source for module in job.program.modules))
        self._interpretation: Interpretation | None = None
        self._texts = {PurePath(text.name).name: text for text in texts}

    def __iter__(self) -> Iterator[Executed]:
        """Execute the program block by block. Raises IrlxError where it cannot go on (IRL090: by a fault)."""
        source = self._carried_out()
        while True:
            try:
                executed = next(source)
            except StopIteration:
                return
            except IrlxError:
                raise
            except Exception as error:
                if os.environ.get("IRLX_DEBUG"):
                    raise
                # A fault of irlx itself must not cost what was executed before it.
                raise IrlxError(report("IRL090", cause=f"{type(error).__name__}: {error}")) from error
            yield executed

    def _carried_out(self) -> Iterator[Executed]:
        """What becomes of the blocks; the program runs ahead of them while its moves pass their targets."""
        ahead = Lookahead(self._locate, self._pacer.notes)
        source, reply = self._interpreted(), None
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

    def _answer(self, question: Question) -> tuple[float, ...]:
        return self._pacer.answer(question)

    def _all(self, groups: Sequence[tuple[Block, ...]]) -> Iterator[Executed]:
        for group in groups:
            yield from self._pacer.carry_out(group)

    def blocks(self) -> Iterator[Block]:
        """Blocks of the program; nothing moves until it asks for the posture that its moves lead to."""
        waiting: list[Block] = []
        source, reply = self._interpreted(), None
        while True:
            try:
                item = source.send(reply)
            except StopIteration:
                return
            reply = None
            if isinstance(item, Question):
                self._move_to_the_end_of(waiting)
                waiting.clear()
                reply = self._pacer.answer(item)
            else:
                yield item
                waiting.append(item)

    def _move_to_the_end_of(self, blocks: Sequence[Block]) -> None:
        """Carry out blocks for their effect on where the robot stands."""
        ahead = Lookahead(self._locate, Notes([]))
        groups = [group for block in blocks for group in ahead.take(block)]
        for _ in self._all([*groups, *ahead.stop(None, "")]):
            pass

    def _interpreted(self) -> Generator[Block | Question, tuple[float, ...] | None, None]:
        """The program under way: its blocks and questions."""
        job, program = self.job, self.job.program
        setting = setting_of(job.cell)
        ready = Interpretation(
            program.tree, program.source, setting, program.data_lists, program.modules, job.max_steps
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
        limits = rows.limits or cell.limits
        dt = self.job.tick_ns / 1e9
        return explain_row(rows, before, tick, limits, cell.weights, self.kinematics, dt)

    def recording(self) -> Recording:
        """A recording that begins at the cell's start posture."""
        start = self.job.cell.start
        return Recording(header_of(self.job), start, *self.kinematics.tool_pose(start))

    @property
    def warnings(self) -> list[Diagnostic]:
        """Warnings of the blocks executed so far."""
        return self._pacer.warnings

    def _locate(self, origin: Origin) -> Place:
        text = self._texts.get(origin.file, self.job.program.source)
        return Place.in_text(text, Span(origin.start, origin.end))


def kinematics_of(cell: Cell) -> Kinematics:
    """Kinematics of a cell's robot with its constraints.

    Raises CellError: IRL617 for a constraint that nobody registered, IRL616 for one that the start breaks.
    """
    plain = Kinematics(cell.robot)
    if not (cell.relations or cell.registered):
        return plain
    names = cell.robot.joint_names
    found: list[Constraint] = [LinearConstraint(relation, names) for relation in cell.relations]
    makers = registered_constraints()
    for asked in cell.registered:
        maker = makers.get(asked.use)
        if maker is None:
            known = ", ".join(sorted(makers)) or "none"
            data: dict[str, Any] = {
                "use": asked.use,
                "near": near_matches(asked.use, sorted(makers)),
                "known": known,
            }
            raise CellError(report("IRL617", asked.place, **data))
        constraint = maker(plain)
        broken = float(np.max(np.abs(constraint.residual(cell.start)), initial=0.0))
        if not broken <= CONDITION:
            told: dict[str, Any] = {"name": asked.name, "found": f"{broken:.6g}", "due": "0"}
            raise CellError(report("IRL616", asked.place, **told))
        found.append(constraint)
    return plain.constrained(found)


def header_of(job: Job) -> StreamHeader:
    """Provenance of the stream of a job; names of files without their folders."""
    program, cell = job.program, job.cell
    return StreamHeader(
        format_version=FORMAT_VERSION,
        irlx_version=__version__,
        program_name=program.path.name,
        program_sha256=program.sha256,
        cell_name=Path(cell.file).name,
        robot_name=cell.robot.name,
        robot_model=cell.model,
        robot_fingerprint=cell.robot.fingerprint,
        tip=cell.robot.tip,
        joint_names=cell.robot.joint_names,
        joint_units=tuple("m" if axis.is_prismatic else "rad" for axis in cell.robot.axes),
        tick_ns=job.tick_ns,
        limits=cell.limits,
        weights=tuple(float(weight) for weight in cell.weights),
    )


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
) -> Run:
    """Interpret a program, move its robot, and return the joint stream.

    `cell`: path of the cell file, by default found beside the program; `tick_ms` overrides the
    cell's tick; `explain_tick` asks for `Run.explanation` of that tick; a move that limits make
    more than `max_slow` times as long as programmed is an error, and so are more than `max_steps`
    statements (by default 10,000,000); `inputs` as `InputsGiven`, in place of the cell's. With `write_data`,
    values of data lists that the program has changed are written to their files after a complete run.
    Raises ProgramError and CellError before anything moves, RunError (with what was executed until then)
    once it does, RunInterrupted on Ctrl-C.
    """
    job = prepare(program, cell, tick_ms, max_slow, max_steps, inputs)
    execution = Execution(job)
    finished = execute(execution, progress, explain_tick)
    if not write_data:
        return finished
    return replace(finished, diagnostics=(*finished.diagnostics, *execution.write_data()))


def execute(execution: Execution, progress: Progress | None = None, explain_tick: int | None = None) -> Run:
    """Run a prepared job to its end; see `run`."""
    job = execution.job
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
        known = (*_warnings(job), *execution.warnings)
        partial = recording.finish(False, (*known, *error.diagnostics))
        partial = replace(partial, explanation=explanation)
        raise RunError((*error.diagnostics, *known), partial) from error
    except KeyboardInterrupt as interrupt:
        raise RunInterrupted(recording.finish(False, (*_warnings(job), *execution.warnings))) from interrupt
    finished = recording.finish(True, (*_warnings(job), *execution.warnings))
    return replace(finished, explanation=explanation)


def _warnings(job: Job) -> tuple[Diagnostic, ...]:
    return (*job.program.diagnostics, *job.cell.warnings)


def stream(
    program: Program | PathLike,
    cell: PathLike | None = None,
    tick_ms: float | None = None,
    max_slow: float | None = None,
    max_steps: int | None = None,
    inputs: InputsGiven = None,
) -> Iterator[Sample]:
    """Samples of a run, one after another, motion by motion as they are asked for.

    The same samples as `run` gives. Iteration may stop at any sample. What cannot be prepared raises
    here, what goes wrong in motion at the sample it keeps from coming, as IrlxError.
    """
    return _samples(prepare(program, cell, tick_ms, max_slow, max_steps, inputs))


def _samples(job: Job) -> Iterator[Sample]:
    execution = Execution(job)
    recording = execution.recording()
    yield from recording.take_samples()
    for executed in execution:
        recording.add(executed)
        yield from recording.take_samples()
