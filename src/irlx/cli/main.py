"""`irlx`: argument parser, dispatch, exit codes.

0 fine; 1 findings, or a program that ended in a robot error; 2 usage, configuration or internal
error; 130 interrupted, 128 + N ended by signal N.
"""

from __future__ import annotations

import argparse
import gc
import os
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import TYPE_CHECKING

from irlx._version import __version__
from irlx.cli.little_memory import expect_little_memory
from irlx.cli.parser import CommandParser
from irlx.cli.standard_channels import OutputLost, drop_output, take_channels
from irlx.cli.stopping import Stopped, heard_signal, heed_signals, ignore_signals, stopped_code

if TYPE_CHECKING:
    from irlx.diagnostics import Diagnostic

_SELDOM = 50_000, 20, 20
"""Objects after which Python looks for garbage, of each generation; its own are 700, 10, 10."""
_COMMANDS = (
    "demo",
    "run",
    "check",
    "fmt",
    "blocks",
    "verify",
    "view",
    "plot",
    "convert",
    "robots",
    "new",
    "explain",
    "completion",
    "conformance",
)
"""Modules of the commands, in the order of the help."""
_STOPPED = 128
"""Exit codes from here on are of commands that were stopped."""
_NO_MEMORY = "error IRL090: internal error: the memory that this process may use is used up"
"""For a moment at which no more than this can be said."""
_LIBRARIES = ("OPENBLAS_NUM", "OMP_NUM", "MKL_NUM", "BLIS_NUM", "VECLIB_MAXIMUM")
"""How variables for the number of threads of linear algebra begin: whose OpenBLAS is, and others'."""
_EXAMPLE = """\
examples:
  irlx demo
  irlx run programs/koch/square.irl
  irlx check programs/koch/square.irl
  irlx verify programs/koch/square.irdata
"""


def build_parser(only: str | None = None) -> argparse.ArgumentParser:
    """Parser of the whole command line, or of one command, which takes less time to build."""
    parser = CommandParser(
        prog="irlx",
        description="Run robot programs in the irlx profile of IRL; joint streams come out, verified.",
        epilog=_EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("-V", "--version", action="version", version=f"irlx {__version__}")
    parser.set_defaults(command=None)
    commands = parser.add_subparsers(title="commands", metavar="COMMAND")
    for name in _COMMANDS if only is None else (only,):
        import_module(f"irlx.cli.{name}").add_parser(commands)
    parser.commands = commands
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command, or print the help without one; returns its exit code.

    Raises SystemExit for --help and what argparse refuses.
    """
    try:
        code = _carried_out(arguments)
        # Here and not at the end of the process: a reader that went away must be met inside this fence.
        sys.stdout.flush()
    except KeyboardInterrupt as interrupt:
        return _stopped(interrupt)
    except BrokenPipeError:
        # The reader of our output went away: nothing is wrong, nothing more can be said.
        drop_output(sys.stdout.fileno())
        return 0
    except Exception as error:
        number = heard_signal()
        # What libraries make of an interruption while they are loaded is none of their errors.
        return _told(error) if number is None else _stopped(Stopped(number))
    return int(code)


def _stopped(interrupt: KeyboardInterrupt) -> int:
    print("irlx: interrupted", file=sys.stderr)
    return stopped_code(interrupt)


def _carried_out(arguments: Sequence[str] | None) -> int:
    """Carry out one command; gives its exit code."""
    first = next(iter(sys.argv[1:] if arguments is None else arguments), None)
    parser = build_parser(first if first in _COMMANDS else None)
    try:
        options = parser.parse_args(arguments)
    except SystemExit:
        # Behind a help, which argparse has printed.
        sys.stdout.flush()
        raise
    if options.command is None:
        parser.print_help()
        return 0
    return int(options.command(options))


def _told(error: Exception) -> int:
    """Print what went wrong; gives the exit code."""
    try:
        return _explained(error)
    except (MemoryError, ImportError):
        # What words messages are made of is loaded only here, and there may be no memory left for that.
        print(_NO_MEMORY, file=sys.stderr)
        return 2


def _explained(error: Exception) -> int:
    """Print what went wrong, with its place and what helps; gives the exit code."""
    # Imported here: what prints a help has no need of messages.
    from irlx.cli.output import exit_code, print_diagnostics
    from irlx.diagnostics import IrlxError, report
    from irlx.diagnostics.fault import fault

    found: Sequence[Diagnostic] = ()
    if isinstance(error, IrlxError):
        found = error.diagnostics
    elif isinstance(error, OutputLost):
        cause = str(error.strerror or error).lower()
        found = (
            report(
                "IRL003",
                path="stdout",
                cause=cause,
                help="files that were asked for are written all the same",
            ),
        )
    elif isinstance(error, FileNotFoundError) and not _has_folder():
        found = (report("IRL002", path=".", cause="the working folder is gone"),)
    elif os.environ.get("IRLX_DEBUG"):
        raise error
    else:
        # The last fence: a fault of irlx itself must still be a message, not a traceback.
        found = (fault(error),)
    print_diagnostics(found)
    return exit_code(found)


def _has_folder() -> bool:
    """Whether the working folder is still there."""
    try:
        os.getcwd()
    except FileNotFoundError:
        return False
    return True


def use_one_thread() -> None:
    """Let libraries of linear algebra that are loaded from now on use one thread.

    Of a robot with many joints beside many obstacles several threads would give other last bits. Matrices are
    small: threads would only wait for each other, the more so on a busy machine.
    """
    for library in _LIBRARIES:
        os.environ[f"{library}_THREADS"] = "1"


def entry_point() -> None:
    """Console entry: `irlx`."""
    # Loading libraries leaves none, and to look for it takes a twentieth of a short run.
    gc.set_threshold(*_SELDOM)
    use_one_thread()
    heed_signals()
    take_channels()
    expect_little_memory()
    try:
        code = main()
    finally:
        ignore_signals()
    if code >= _STOPPED:
        # Python would end itself by the signal where its exception has passed through an exec() on its way.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
    sys.exit(code)
