"""`irlx demo`: the first minute, a commented program that is run, verified and replayed."""

from __future__ import annotations

import argparse
import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from irlx.report.lines import Line
    from irlx.report.outcome import Outcome
    from irlx.verifier import Report

_EXAMPLE = """\
examples:
  irlx demo
  irlx demo try_it --open
  irlx demo on_a_rail --robot rail6
"""
_FOLDER = "irlx-demo"
_LABELS = frozenset({"slowed", "clearance", "cyclic"})
"""Labels of the lines of the summary that a first look is about."""


class _Files(NamedTuple):
    """What a demo writes."""

    program: Path
    cell: Path
    stream: Path
    page: Path


def add_parser(commands: Any) -> None:
    """Add the command to the command line."""
    parser = commands.add_parser(
        "demo",
        help="begin here: write a program, run, verify and replay it",
        description="Write a commented program and its cell into a folder, run it, verify its stream, make a "
        "page that replays it, and say what to try next.",
        epilog=_EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "folder",
        nargs="?",
        default=_FOLDER,
        metavar="FOLDER",
        help=f"a folder that is new or empty (default: {_FOLDER})",
    )
    parser.add_argument(
        "--robot",
        metavar="ROBOT",
        help="another robot, by a name that irlx robots lists: first moves as of irlx new",
    )
    parser.add_argument("--open", action="store_true", help="open the page in the browser")
    parser.set_defaults(command=command)


def command(options: argparse.Namespace) -> int:
    """Write, run, verify, tell; exit code 1 where the verification failed."""
    folder = Path(options.folder)
    _check_empty(folder)
    texts = _texts(folder, options.robot)
    files = _Files(*(folder / f"demo.{ending}" for ending in ("irl", "toml", "irdata", "html")))
    _write(files, *texts)
    run, judged = _executed(files)
    _print(run, judged, files, options.robot)
    if options.open:
        import webbrowser

        webbrowser.open(files.page.resolve().as_uri())
    return 0 if judged.passed else 1


def _check_empty(folder: Path) -> None:
    """Raises IrlxError: IRL018 for a folder that holds something, IRL003 for what can be no folder."""
    from irlx.cell.find import is_file
    from irlx.diagnostics import IrlxError, report

    if is_file(folder):
        cause = "it is a file, not a folder"
        raise IrlxError(report("IRL003", path=folder, cause=cause, help="name another folder"))
    try:
        filled = folder.exists() and any(folder.iterdir())
    except OSError as cause:
        raise IrlxError(_unwritable(folder, cause)) from cause
    if filled:
        other = folder.parent / f"{folder.resolve().name or 'demo'}_2"
        raise IrlxError(report("IRL018", path=folder, other=shlex.quote(str(other))))


def _unwritable(path: Path, cause: OSError) -> Any:
    from irlx.diagnostics import report

    return report("IRL003", path=path, cause=cause.strerror or str(cause), help="name another folder")


def _texts(folder: Path, robot: str | None) -> tuple[str, str]:
    """Program and cell. Raises IrlxError, IRL006, for a robot that nobody knows."""
    from irlx.cell.packaged import DEMO_ROBOT, demo_texts

    if robot is None or robot == DEMO_ROBOT:
        return demo_texts()
    from irlx.cli.new import known_robot
    from irlx.cli.output import print_diagnostics
    from irlx.cli.progress import shown_status

    known_robot(robot)
    with shown_status(f"looking for first moves of {robot}"):
        from irlx.first_program import first_program

        found = first_program("demo", robot, None, folder)
    if found.warning is not None:
        print_diagnostics((found.warning,))
    return found.program, found.cell


def _write(files: _Files, program: str, cell: str) -> None:
    """Write both into the folder. Raises IrlxError, IRL003."""
    from irlx.cli.new import write_text
    from irlx.diagnostics import IrlxError

    try:
        files.program.parent.mkdir(parents=True, exist_ok=True)
    except OSError as cause:
        raise IrlxError(_unwritable(files.program.parent, cause)) from cause
    write_text(files.program, program)
    write_text(files.cell, cell)


def _executed(files: _Files) -> tuple[Outcome, Report]:
    """Run the program, and judge its stream. Raises RunError, whose findings tell why it ended."""
    from irlx.cli.output import print_diagnostics
    from irlx.cli.progress import shown_progress
    from irlx.job import prepare
    from irlx.pipeline import Execution
    from irlx.running import execute_to_files
    from irlx.verification import verify

    job = prepare(files.program)
    with shown_progress(job) as progress:
        execution = Execution(job, watch=progress)
        run = execute_to_files(execution, [files.stream], progress, page=files.page)
        if progress is not None:
            progress.says(f"verifying {files.stream}")
        judged = verify(files.stream, files.program, files.cell)
    print_diagnostics(run.diagnostics)
    print_diagnostics(judged.diagnostics(str(files.stream)))
    return run, judged


def _print(run: Outcome, judged: Report, files: _Files, robot: str | None) -> None:
    from irlx.cli.output import print_lines
    from irlx.report.lines import Line, Tone, columns
    from irlx.report.terminal import failed_lines

    checked = f", {len(judged.made)} checks passed" if judged.passed else ""
    rows = [
        (str(files.program), "the program, with comments"),
        (str(files.cell), "its cell: robot, limits, surroundings"),
        (str(files.stream), f"the stream: {run.summary.samples} samples{checked}"),
    ]
    lines = [*_short(run, judged), *(Line("written", words) for words in columns(rows))]
    lines += failed_lines({str(files.stream): judged})
    print_lines([*lines, Line("page", files.page.resolve().as_uri(), Tone.GOOD)])
    print("\nNext, for instance:")
    print_lines([Line(None, f"  {words}", Tone.FIGURE) for words in _next(files, robot)])


def _short(run: Outcome, judged: Report) -> list[Line]:
    """The verdict, and what a first look is about."""
    from irlx.report.terminal import summary_lines

    lines, label = [], ""
    for line in summary_lines(run.summary, judged.passed):
        label = label if line.label == "" else line.label or ""
        if line.label is None or label in _LABELS:
            lines.append(line)
    return lines


def _next(files: _Files, robot: str | None) -> list[str]:
    """Three commands to try, with what they do; a shell takes that for a comment."""
    program, stream = (shlex.quote(str(path)) for path in (files.program, files.stream))
    from irlx.report.lines import columns

    another = "arm7" if robot == "rail6" else "rail6"
    return columns(
        [
            (f"irlx run {program}", "# again: change a number in it first"),
            (f"irlx plot {stream}", "# every joint over time, here"),
            (f"irlx new first --robot {another}", "# a cell and a program for another robot"),
        ]
    )
