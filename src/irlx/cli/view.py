"""`irlx view`: a program or a stream in the browser, live."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from irlx.cli.execution import add_execution_options, add_plugin_option, import_plugins, standard_input

if TYPE_CHECKING:
    from irlx.viewer.subject import Subject

_EXAMPLE = """\
examples:
  irlx view programs/koch/square_slow.irl
  irlx view programs/window/window.irl --tick 20 --port 8090
  irlx view programs/koch/square.irdata --cell programs/koch/square.toml --no-open
"""


def add_parser(commands: Any) -> None:
    """Add the command to the command line."""
    parser = commands.add_parser(
        "view",
        help="run a program and see it in the browser, live",
        description="Run a program and serve a page on this machine that shows it: the robot, the program, "
        "obstacles that can be moved, and the program run again with them. Needs the extra view. "
        "Ctrl-C ends it.",
        epilog=_EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("program", metavar="P", help="program file, or a stream file, shown as it is")
    parser.add_argument("--cell", metavar="C.toml", help="cell file (default: found beside the program)")
    parser.add_argument("--tick", type=float, metavar="MS", help="duration of a tick (default: the cell's)")
    parser.add_argument(
        "--port",
        type=int,
        metavar="N",
        help="port of the page, 0 for a free one (default: 8080, or the next)",
    )
    parser.add_argument(
        "--host",
        default="127.0.0.1",
        metavar="ADDRESS",
        help="address to serve on (default: 127.0.0.1, which no other machine reaches)",
    )
    parser.add_argument("--no-open", action="store_true", help="do not open the page in a browser")
    add_execution_options(parser)
    add_plugin_option(parser)
    parser.set_defaults(command=command)


def command(options: argparse.Namespace) -> int:
    """Serve the page until Ctrl-C; exit code 1 for a program that ended in an error."""
    from irlx.cli.output import exit_code, print_diagnostics
    from irlx.viewer.serve import free_port, require_viewer

    require_viewer()
    port = free_port(options.host, options.port)
    import_plugins(options.plugin)
    subject = _subject(options)
    print_diagnostics(subject.errors or subject.shown.diagnostics)
    from irlx.viewer.view import serve_until_ctrl_c
    from irlx.viewer.viewer import Viewer

    viewer = Viewer(subject.shown, subject.again, options.host, port)
    print_diagnostics(viewer.diagnostics)
    serve_until_ctrl_c(viewer, not options.no_open)
    return exit_code(subject.errors)


def _subject(options: argparse.Namespace) -> Subject:
    from irlx.program import load

    path = Path(options.program)
    cell = None if options.cell is None else Path(options.cell)
    # Before the numeric libraries are imported: a mistake in the text is told at once.
    program = load(path, cell) if path.suffix.lower() == ".irl" else path
    from irlx.job import prepare
    from irlx.viewer.subject import is_stream, subject_of_job, subject_of_stream

    if is_stream(path):
        return subject_of_stream(path, cell)
    asked = options.tick, None, options.max_steps, options.inputs, options.files
    return subject_of_job(prepare(program, cell, *asked, standard_input()))
