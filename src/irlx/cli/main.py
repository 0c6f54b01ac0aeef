"""`irlx`: argument parser, dispatch, exit codes.

0 fine; 1 findings, or a program that ended in a robot error; 2 usage, configuration or internal
error; 130 interrupted.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import TYPE_CHECKING

from irlx._version import __version__
from irlx.cli.parser import CommandParser

if TYPE_CHECKING:
    from irlx.diagnostics import Diagnostic

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
    first = next(iter(sys.argv[1:] if arguments is None else arguments), None)
    parser = build_parser(first if first in _COMMANDS else None)
    try:
        options = parser.parse_args(arguments)
        if options.command is None:
            parser.print_help()
            return 0
        code = options.command(options)
        # Here and not at the end of the process: a reader that went away must be met inside this fence.
        sys.stdout.flush()
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        # The reader of our output went away: nothing is wrong, nothing more can be said.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except Exception as error:
        return _told(error)
    return int(code)


def _told(error: Exception) -> int:
    """Print what went wrong; gives the exit code."""
    # Imported here: what prints a help has no need of messages.
    from irlx.cli.output import exit_code, print_diagnostics
    from irlx.diagnostics import IrlxError, report

    found: Sequence[Diagnostic] = ()
    if isinstance(error, IrlxError):
        found = error.diagnostics
    elif os.environ.get("IRLX_DEBUG"):
        raise error
    else:
        # The last fence: a fault of irlx itself must still be a message, not a traceback.
        found = (report("IRL090", cause=f"{type(error).__name__}: {error}"),)
    print_diagnostics(found)
    return exit_code(found)


def entry_point() -> None:
    """Console entry: `irlx`."""
    # Matrices here are small: threads of the linear algebra would only wait for each other, the more so on a
    # busy machine. Set before anything loads it; who asks for more threads gets them.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    sys.exit(main())
