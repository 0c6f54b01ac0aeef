"""A program from its text to its joint stream: in memory, to files, or sample by sample."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import IO, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import Block, Origin
from irlx.diagnostics import Diagnostic, IrlxError, report
from irlx.given_inputs import InputsGiven
from irlx.given_values import check_count
from irlx.interpreter.channels.pieces import InputGiven
from irlx.job import CellGiven, Job, PathLike, prepare
from irlx.language.suppression import without_ignored
from irlx.pacing.correction.corrector import Senses
from irlx.pacing.correction.nearness import Nearness
from irlx.pacing.correction.share import CORRECTION_SHARE
from irlx.pacing.correction.tally import Tally
from irlx.pacing.executed import Executed
from irlx.pacing.explanation import TickExplanation
from irlx.pacing.pauses import PauseFunction
from irlx.pipeline import Execution
from irlx.program import Program
from irlx.report.file_recording import FileRecording
from irlx.report.outcome import Outcome
from irlx.report.outputs import overwrites, written
from irlx.report.recorder import Recorder
from irlx.report.recording import Recording
from irlx.report.replay.names import is_page
from irlx.report.replay.source import ReplaySource
from irlx.report.replay.writer import PageWriter
from irlx.report.run import Run, RunError, RunInterrupted
from irlx.report.samples import Samples
from irlx.scene.sightings import Sightings
from irlx.streams.error import StreamError
from irlx.streams.sample import Sample
from irlx.streams.sample_stream import SampleStream
from irlx.streams.sampler import Sampler

Array = NDArray[np.float64]
Progress = Callable[[Block, float], None]
"""Called after each block with the block and the simulated time so far, s."""

Result_co = TypeVar("Result_co", bound=Outcome, covariant=True)

Sensor = Callable[[Sample], Sequence[float] | Array | None]
"""Called with the last sample; gives the correction that the tool is to have, None to leave it."""

Watcher = Callable[[Sample], Mapping[str, Sequence[float] | Array | None] | None]
"""Called with the last sample; gives poses of obstacles by name, None to leave them where they are."""


def run(
    program: Program | PathLike,
    cell: CellGiven = None,
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

    `cell`: path of the cell file, by default found beside the program, or a cell that has been loaded;
    `tick_ms` overrides the cell's tick; `explain_tick` asks for `Run.explanation` of that tick; a move that
    limits make more than `max_slow` times as long as programmed is an error, and so are more than `max_steps`
    statements (by default 10,000,000); `inputs` as `InputsGiven`, each instead of the cell's; a PAUSE lasts
    `pause_s` s, rounded up to whole ticks. With `write_data`, values of data lists that the program has
    changed are written to their files after a complete run.
    `files`: the folder that OPEN finds and makes files in, by default that of the program; `input`: what
    STANDARD_IN reads, a text or a file that is open; `output`: what gets the text for STANDARD_OUT while it
    is written, for instance sys.stdout, beside `Run.output`.
    Raises ProgramError and CellError before anything moves, RunError (with what was executed until then)
    once it does, RunInterrupted on Ctrl-C.
    """
    channels = files, input, output
    check_count("explain_tick=", explain_tick, 0)
    job = prepare(program, cell, tick_ms, max_slow, max_steps, inputs, *channels, pause_s)
    execution = Execution(job)
    finished = execute(execution, progress, explain_tick)
    if not write_data:
        return finished
    return replace(finished, diagnostics=(*finished.diagnostics, *execution.write_data()))


def record(
    program: Program | PathLike,
    outputs: PathLike | Sequence[PathLike],
    cell: PathLike | None = None,
    tick_ms: float | None = None,
    progress: Progress | None = None,
    explain_tick: int | None = None,
    max_slow: float | None = None,
    max_steps: int | None = None,
    inputs: InputsGiven = None,
    files: PathLike | None = None,
    input: InputGiven = None,
    output: IO[str] | None = None,
    pause_s: float = 0.0,
) -> Outcome:
    """Run a program and write its joint stream to files while it goes on, with little memory however long.

    `outputs` is a path, or several, each in the format of its ending, one of them with the ending .html for a
    page that replays the run; all else as in `run`. The files appear
    at the end, whole. Of a program that ends in an error, and after Ctrl-C, what was executed appears beside
    them as `NAME.partial.ENDING`, marked incomplete. The program itself cannot write these files. Raises what
    `run` raises, and before anything moves StreamError: IRL003 where a file cannot be written, IRL004 for an
    unknown ending, IRL005 where an input would be overwritten. A file that cannot be written any more later
    on is a RunError; where it is known only at the end, its `run` is complete, `files` those that appeared.
    """
    channels = files, input, output
    check_count("explain_tick=", explain_tick, 0)
    job = prepare(program, cell, tick_ms, max_slow, max_steps, inputs, *channels, pause_s)
    paths = [outputs] if isinstance(outputs, str | os.PathLike) else list(outputs)
    streams = [Path(path) for path in paths if not is_page(path)]
    pages = [Path(path) for path in paths if is_page(path)]
    if len(pages) > 1:
        raise IrlxError(report("IRL006", option="outputs=", value=str(pages[1]), cause="one page a run"))
    page = pages[0] if pages else None
    given = [Path(inputs)] if isinstance(inputs, str | os.PathLike) else []
    for path in (*streams, *pages):
        if any(overwrites(path, source) for source in (job.program.path, Path(job.cell.file), *given)):
            raise StreamError(report("IRL005", option="outputs=", path=path))
    protected = job.channels.protecting(written(streams), "a stream of this run")
    job = replace(job, channels=protected.protecting(written(pages), "the page of this run"))
    return execute_to_files(Execution(job), streams, progress, explain_tick, page)


def execute(execution: Execution, progress: Progress | None = None, explain_tick: int | None = None) -> Run:
    """Run a prepared job to its end; see `run`."""
    recording = Recording(*execution.start(), execution.tool_in, replay_source(execution.job))
    return _finished(execution, recording, progress, explain_tick)


def execute_to_files(
    execution: Execution,
    outputs: Sequence[Path],
    progress: Progress | None = None,
    explain_tick: int | None = None,
    page: Path | None = None,
) -> Outcome:
    """Run a prepared job to its end, its rows going to files, and a replay to a `page`; see `record`."""
    header, start, rotation, position = execution.start()
    writer = None if page is None else PageWriter(page, header, replay_source(execution.job))
    pose = rotation, position
    recording = FileRecording(header, start, pose, outputs, execution.tool_in, writer)
    try:
        return _finished(execution, recording, progress, explain_tick)
    finally:
        # Nothing is left to remove, unless something went wrong that ends the process.
        recording.abort()


class _Recording(Protocol[Result_co]):
    """What collects a run."""

    @property
    def last_postures(self) -> Array: ...
    @property
    def duration(self) -> float: ...
    def add(self, executed: Executed) -> None: ...
    def say(self, text: str, origin: Origin | None = None) -> None: ...
    def finish(self, complete: bool, diagnostics: tuple[Diagnostic, ...]) -> Result_co: ...


def _finished(
    execution: Execution,
    recording: _Recording[Result_co],
    progress: Progress | None,
    explain_tick: int | None,
) -> Result_co:
    """What a run has come to. Raises RunError and RunInterrupted with what was executed until then."""
    explanation: TickExplanation | None = None

    def finish(complete: bool, diagnostics: tuple[Diagnostic, ...]) -> Result_co:
        found = recording.finish(complete, diagnostics)
        return replace(found, explanation=explanation, output=execution.channels.output)

    execution.channels.heard_by(recording.say)
    try:
        for executed in execution:
            if explain_tick is not None and explanation is None:
                explanation = execution.explain(executed, recording.last_postures, explain_tick)
            recording.add(executed)
            if progress is not None:
                progress(executed.block, recording.duration)
    except IrlxError as error:
        known = _told(execution)
        partial = finish(False, (*known, *error.diagnostics))
        unwritten = (d for d in partial.diagnostics if d.is_error and d not in error.diagnostics)
        raise RunError((*error.diagnostics, *unwritten, *known), partial) from error
    except KeyboardInterrupt as interrupt:
        also = interrupt.__context__
        failed = also.diagnostics if isinstance(also, IrlxError) else ()
        raise RunInterrupted(finish(False, (*_told(execution), *failed))) from interrupt
    finished = finish(True, _told(execution))
    if any(found.is_error for found in finished.diagnostics):
        raise RunError(finished.diagnostics, finished)
    return finished


def replay_source(job: Job) -> ReplaySource:
    """What a replay of a job shows beside its rows."""
    text = job.program.source
    return ReplaySource(job.cell, None if text is None else text.text)


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
    with IRL438 for a task in the frame of a link, IRL583 for a cell with constraints, IRL006 for what is no
    function; at a sample IRL580, IRL581, IRL582 for an answer that is none, IRL584 for a correction for which
    new limits leave no room.

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
    frame = execution.kinematics.description.task_frame
    if frame is not None:
        raise IrlxError(report("IRL438", frame=frame))
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
    header, start, rotation, position = execution.start()
    samples = Samples(header)
    recorder = Recorder(header, start, rotation, position, (samples,))
    yield from samples.new()
    for executed in execution:
        recorder.add(executed)
        yield from samples.new()


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
