"""What `irlx view` is given, as what is to be seen, and how it is run again."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import cast

from irlx.cell.cell import Cell
from irlx.cell.errors import CellError
from irlx.cell.load import load_cell, own_cell
from irlx.cell.named import robot_names
from irlx.diagnostics import Diagnostic, Place, SourceText, report
from irlx.job import Job, prepare
from irlx.pipeline import Execution
from irlx.recorded import cell_beside, check_joints, is_recorded, recorded, text_beside
from irlx.report.run import Run, RunError
from irlx.running import Progress, execute
from irlx.streams.formats import format_of, read_stream
from irlx.streams.joint_stream import JointStream, StreamHeader
from irlx.viewer.rerun import Again
from irlx.viewer.shown import Shown, shown_run, shown_stream


@dataclass(frozen=True)
class Subject:
    """What is shown, what runs it again (None: nothing can), and the `errors` that a run ended in."""

    shown: Shown
    again: Again | None = None
    errors: tuple[Diagnostic, ...] = ()


def subject_of_job(job: Job, progress: Progress | None = None) -> Subject:
    """The run of a job, which is run here; one that ends in an error is shown as far as it came."""
    again = _again(job)
    try:
        run = execute(Execution(job), progress)
    except RunError as error:
        return Subject(shown_run(cast("Run", error.run), job.cell, _text(job)), again, error.diagnostics)
    return Subject(shown_run(run, job.cell, _text(job)), again)


def subject_of_run(run: Run, cell: Path | None = None) -> Subject:
    """A run that has been made; its program is not there to be run again."""
    path, source = Path(run.header.program_name or "run"), run.source
    of_run = source.cell if source is not None and cell is None else _cell(path, run.stream, cell)
    if source is None or source.program_text is None:
        text = text_beside(path, run.header)
    else:
        text = SourceText(str(path), source.program_text)
    return Subject(shown_run(run, of_run, text))


def subject_of_stream(path: Path, cell: Path | None = None) -> Subject:
    """A stream file as it is, run again as its replay, where its format tells its blocks.

    Raises StreamError for a file that cannot be read; CellError without a cell that has its joints.
    """
    stream = read_stream(path)
    where = _cell(path, stream, cell)
    shown = shown_stream(stream, path.name, where, text_beside(path, stream.header))
    shown = replace(shown, diagnostics=_other_robot(path, stream.header, where))
    if not (stream.complete and format_of(path).carries_blocks):
        return Subject(shown)
    return Subject(shown, _again(prepare(recorded(path), where)))


def is_stream(path: Path) -> bool:
    """Whether a file is a stream by its ending."""
    return is_recorded(path)


def _again(job: Job) -> Again:
    made = replace(job.making, cell_sha256="", given=(*job.making.given, "cell"))

    def again(cell: Cell, progress: Progress) -> Shown:
        changed = replace(job, cell=cell, making=made)
        return shown_run(execute(Execution(changed), progress), cell, _text(job))

    return again


def _text(job: Job) -> SourceText | None:
    return job.program.source


def _cell(path: Path, stream: JointStream, given: Path | None) -> Cell:
    """The cell of a stream: the one given, or found beside it; else that of its robot, known by name."""
    header = stream.header
    try:
        found = load_cell(cell_beside(path, header, given))
    except CellError as error:
        if error.reason.code != "IRL609" or header.robot_model not in robot_names():
            raise
        found = own_cell(header.robot_model)
    check_joints(header, found)
    return found


def _other_robot(path: Path, header: StreamHeader, cell: Cell) -> tuple[Diagnostic, ...]:
    if header.robot_fingerprint == cell.robot.fingerprint:
        return ()
    told = {"name": path.name, "robot": header.robot_name or "robot", "cell": Path(cell.file).name}
    return (report("IRL015", Place(str(path)), **told),)  # type: ignore[arg-type]
