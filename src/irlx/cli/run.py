"""`irlx run`: interpret, move, write, verify, summarise."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, cast

from irlx.cli.execution import add_execution_options, add_plugin_option, import_plugins, standard_input
from irlx.cli.outputs import output_paths, page_path
from irlx.cli.program_text import ProgramText, TypedInput
from irlx.cli.progress import shown_progress
from irlx.cli.stopping import stopped_code

if TYPE_CHECKING:
    from irlx.diagnostics import Diagnostic
    from irlx.job import Job
    from irlx.pipeline import Execution
    from irlx.program import Program
    from irlx.report.outcome import Outcome
    from irlx.report.progress import Progress
    from irlx.verifier import Report

_EXAMPLE = """\
examples:
  irlx run programs/koch/square.irl
  irlx run programs/koch/square.irl --tick 25 -o square.npz -o square.csv
  irlx run programs/koch/square_cyclic.irl --html square.html
  irlx run programs/koch/square.irdata --cell programs/koch/square.toml
"""


def add_parser(commands: Any) -> None:
    """Add the command to the command line."""
    parser = commands.add_parser(
        "run",
        help="run a program and write its joint stream",
        description="Interpret a program, move its robot, write the joint stream, verify what was written.",
        epilog=_EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "program", metavar="P", nargs="?", help="program file, or a stream file that is to be replayed"
    )
    parser.add_argument("--cell", metavar="C.toml", help="cell file (default: found beside the program)")
    _add_output_options(parser)
    parser.add_argument("--tick", type=float, metavar="MS", help="duration of a tick (default: the cell's)")
    parser.add_argument(
        "--max-slow",
        type=float,
        metavar="F",
        help="end with IRL525 where limits make a move more than F times as long as programmed",
    )
    parser.add_argument(
        "--pause",
        type=float,
        default=0.0,
        metavar="SEC",
        help="stand for SEC s, rounded up to whole ticks, at each PAUSE (default: go on at once)",
    )
    add_execution_options(parser)
    parser.add_argument(
        "--explain-tick",
        type=int,
        metavar="N",
        help="also tell what decided tick N: demand, bounds of every joint with their source, criteria",
    )
    add_plugin_option(parser)
    parser.add_argument(
        "--write-data",
        action="store_true",
        help="after a complete run, write values of data lists that the program changed back to their files",
    )
    parser.add_argument(
        "--reproduce",
        metavar="OUT",
        help="make the stream of a file again from what it says, and compare; P, --cell and --inputs "
        "where these are not beside it",
    )
    parser.add_argument("--json", action="store_true", help="print the summary as JSON")
    parser.add_argument("--quiet", action="store_true", help="nothing but findings and failures")
    parser.add_argument("--no-verify", action="store_true", help="do not check the written files")
    parser.set_defaults(command=command, refuse=parser.error)


def _add_output_options(parser: Any) -> None:
    """Add `--output` and `--html`."""
    parser.add_argument(
        "-o",
        "--output",
        action="append",
        default=[],
        metavar="OUT",
        help="stream, format by its ending: .irdata, .npz, .jsonl, .csv, .parquet, .rosbag; may be given "
        "several times (default: P.irdata beside the program, or in the working folder; of a replay "
        "P.replay.irdata)",
    )
    parser.add_argument(
        "--html",
        action="append",
        default=[],
        metavar="F.html",
        help="also write a page that replays the run: robot, program and curves in one file for any browser",
    )


def command(options: argparse.Namespace) -> int:
    """Run the program; exit code 1 where it ended in an error or the verification failed."""
    from irlx.cli.output import exit_code, print_diagnostics

    if options.reproduce is not None:
        from irlx.cli.reproduce import reproduced

        return reproduced(options)
    if options.program is None:
        options.refuse("the following arguments are required: P")
    text = ProgramText()
    job, outputs, page = _prepared(options, text)
    from irlx.pipeline import Execution
    from irlx.report.run import RunError, RunInterrupted

    try:
        with shown_progress(job, options.quiet or options.json) as progress:
            # A program whose text goes elsewhere does not disturb the line.
            text.first = progress.silence if progress is not None and sys.stdout.isatty() else None
            execution = Execution(job, watch=progress)
            run = _executed(execution, outputs, progress, options.explain_tick, page)
            reports = _reports(job, run.files, progress, options)
    except RunError as error:
        text.end_line()
        print_diagnostics(error.diagnostics)
        if not options.json:
            _print_tick(error.run, options)
        why = _why(error.diagnostics[0], error.run)
        _tell_partial(error.run, [*outputs, *_pages(page)], why, options)
        return exit_code(error.diagnostics)
    except RunInterrupted as interrupt:
        text.end_line()
        print_diagnostics(found for found in interrupt.run.diagnostics if found.is_error)
        print("irlx: interrupted", file=sys.stderr)
        _tell_partial(interrupt.run, [*outputs, *_pages(page)], "interrupted", options)
        return stopped_code(interrupt)
    if not options.quiet or run.diagnostics:
        text.end_line()
        print_diagnostics(run.diagnostics)
    _tell_left([*outputs, *_pages(page)], run, options)
    broken = [found for name, report in reports.items() for found in report.diagnostics(name)]
    print_diagnostics(broken)
    unwritten = exit_code(run.diagnostics)
    if options.write_data and not (broken or unwritten):
        # Behind the verification, which reads the lists as they were.
        print_diagnostics(execution.write_data())
    if broken or options.explain_tick is not None:
        text.end_line()
    _print_summary(run, reports, broken, options)
    return unwritten or int(bool(broken))


def _executed(
    execution: Execution, outputs: list[Path], progress: Progress | None, tick: int | None, page: Path | None
) -> Outcome:
    """The complete run; what could not be written at its end is among its diagnostics.

    Raises RunError and RunInterrupted for one that is not complete.
    """
    from irlx.report.run import RunError
    from irlx.running import execute_to_files

    try:
        return execute_to_files(execution, outputs, progress, tick, page)
    except RunError as error:
        if not error.run.complete:
            raise
        return error.run


def _pages(page: Path | None) -> list[Path]:
    return [] if page is None else [page]


def _prepared(options: argparse.Namespace, text: ProgramText) -> tuple[Job, list[Path], Path | None]:
    """Job, streams and page to write; what is wrong with them goes to stdout as well where JSON is wanted."""
    import json
    from dataclasses import replace

    from irlx.diagnostics import IrlxError
    from irlx.program import load

    try:
        import_plugins(options.plugin)
        # Before the numeric libraries are imported: a mistake in the text is told at once.
        given: Program | Path = Path(options.program)
        if Path(options.program).suffix.lower() == ".irl":
            given = load(options.program, options.cell)
        from irlx.job import prepare
        from irlx.report.outputs import written

        asked = options.tick, options.max_slow, options.max_steps, options.inputs
        output = None if options.json else cast("IO[str]", text)
        typed = standard_input()
        told = options.files, None if typed is None else cast("IO[bytes]", TypedInput(typed, text)), output
        job = prepare(given, options.cell, *asked, *told, pause_s=options.pause)
        program = job.program
        read = [*(found.path for found in program.data_lists), *(found.path for found in program.modules)]
        inputs = (program.path, Path(job.cell.file), *read)
        inputs += () if options.inputs is None else (Path(options.inputs),)
        asked_for = options.output or [_default_output(job)]
        outputs = output_paths(asked_for, inputs)
        page = page_path(options.html, inputs, outputs)
        channels = job.channels.protecting(written(outputs), "a stream of this run")
        channels = channels.protecting(written(_pages(page)), "the page of this run")
        if options.inputs is not None:
            channels = channels.protecting((Path(options.inputs),), "the inputs of this run")
        return replace(job, channels=channels), outputs, page
    except IrlxError as error:
        if options.json:
            nothing: dict[str, object] = {"summary": None, "output": "", "files": [], "page": None}
            plain = {**nothing, "diagnostics": _plain_diagnostics(error.diagnostics)}
            print(json.dumps(plain, indent=2))
        raise


def _default_output(job: Job) -> Path:
    from irlx.recorded import Recorded

    path = job.program.path
    ending = f".replay{path.suffix}" if isinstance(job.program, Recorded) else ".irdata"
    beside = path.with_suffix(ending)
    return beside if os.access(beside.parent, os.W_OK) else Path(beside.name)


def _tell_left(asked: Sequence[Path], run: Outcome, options: argparse.Namespace) -> None:
    """Say which files beside those of a complete run are older than it; they are nobody's to remove."""
    from irlx.cli.output import encodable
    from irlx.report.file_recording import partial_name

    made = {*run.files, run.page}
    names = [partial_name(path) if path in made else path for path in asked]
    for path in () if options.quiet else names:
        if path.exists():
            words = f"irlx: {path} is left as it was, from an earlier run"
            print(encodable(words, sys.stderr), file=sys.stderr)


def _why(error: Diagnostic, run: Outcome) -> str:
    """What ended a run, in short: its message has been printed."""
    from irlx.report.unreached import unreached_time

    line = error.place.line if error.place is not None else None
    words = error.code if line is None else f"{error.code} at line {line}"
    time = unreached_time(error, run.summary.samples - 1, run.header.dt)
    return words if time is None else f"{words}, which would come at {time:.6g} s"


def _tell_partial(run: Outcome, outputs: list[Path], why: str, options: argparse.Namespace) -> None:
    """Say how far it came and where that is: the asked names only ever hold complete streams."""
    import json

    from irlx.cli.output import encodable, print_lines
    from irlx.report.terminal import stop_line

    if not options.quiet:
        print_lines([stop_line(run.summary, why)], sys.stderr)
    for path in outputs:
        if path.exists():
            print(
                encodable(f"irlx: {path} is left as it was, from an earlier run", sys.stderr), file=sys.stderr
            )
    for path in run.files:
        words = f"the stream up to the last stop ({run.summary.duration:.6g} s), marked incomplete: {path}"
        print(encodable(f"irlx: {words}", sys.stderr), file=sys.stderr)
    if run.page is not None:
        words = f"a page of what was executed: {run.page}"
        print(encodable(f"irlx: {words}", sys.stderr), file=sys.stderr)
    if options.json:
        plain = {
            "summary": run.summary.to_plain(),
            "output": run.output,
            "files": [str(path) for path in run.files],
            "page": None if run.page is None else str(run.page),
            "diagnostics": _plain_diagnostics(run.diagnostics),
        }
        print(json.dumps(plain, indent=2))


def _print_tick(run: Outcome, options: argparse.Namespace) -> None:
    from irlx.cli.output import encodable
    from irlx.report.tick_text import tick_text

    if options.explain_tick is None:
        return
    words = (
        f"tick {options.explain_tick}: no motion has it; motions have ticks 1 to {run.summary.samples - 1}"
    )
    if run.explanation is not None:
        words = tick_text(run.explanation)
    print(encodable(words, sys.stdout) + "\n")


def _plain_diagnostics(diagnostics: Iterable[Diagnostic]) -> list[dict[str, object]]:
    from irlx.diagnostics.plain import plain_diagnostic

    return [plain_diagnostic(diagnostic) for diagnostic in diagnostics]


def _reports(
    job: Job, outputs: Sequence[Path], progress: Progress | None, options: argparse.Namespace
) -> dict[str, Report]:
    """What the verifier says of each file, by its name."""
    reports = {}
    for path in () if options.no_verify else outputs:
        if progress is not None:
            progress.says(f"verifying {path}")
        reports[str(path)] = _verified(path, job)
    return reports


def _verified(path: Path, job: Job) -> Report:
    from irlx.program import Program
    from irlx.verification import verify

    # What is replayed may be gone as a text.
    program = job.program if isinstance(job.program, Program) else None
    return verify(path, program, job.cell, job.max_steps)


def _print_summary(
    run: Outcome,
    reports: dict[str, Report],
    broken: list[Diagnostic],
    options: argparse.Namespace,
) -> None:
    import json

    from irlx.cli.output import print_lines
    from irlx.report.lines import Line
    from irlx.report.terminal import failed_lines, file_lines, summary_lines

    if options.json:
        plain = {
            "summary": run.summary.to_plain(),
            "output": run.output,
            "tick": run.explanation.to_plain() if run.explanation is not None else None,
            "files": [str(path) for path in run.files],
            "page": None if run.page is None else str(run.page),
            "verified": {name: report.passed for name, report in reports.items()},
            "diagnostics": _plain_diagnostics([*run.diagnostics, *broken]),
        }
        print(json.dumps(plain, indent=2))
        return
    _print_tick(run, options)
    if options.quiet:
        print_lines(failed_lines(reports))
        return
    verified = None if options.no_verify or not reports else not broken
    files = file_lines(run.summary, [str(path) for path in run.files], reports)
    pages = [] if run.page is None else [Line("page", str(run.page))]
    print_lines([*summary_lines(run.summary, verified), *files, *pages])
