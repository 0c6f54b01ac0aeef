"""`irlx check`: findings on programs, without motion."""

from __future__ import annotations

import argparse
from typing import Any

_EXAMPLE = "example:\n  irlx check programs/koch/square.irl --cell programs/koch/square.toml\n"


def add_parser(commands: Any) -> None:
    """Add the command to the command line."""
    parser = commands.add_parser(
        "check",
        help="look for mistakes in programs, without running them",
        description="Look for mistakes in programs, without running them.",
        epilog=_EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("programs", nargs="+", metavar="P.irl", help="program, module or data list files")
    parser.add_argument("--cell", metavar="C.toml", help="check this cell file, too")
    parser.set_defaults(command=command)


def command(options: argparse.Namespace) -> int:
    """Print the findings on stderr and a line a program on stdout; 1 where there are errors."""
    import sys

    from irlx.checking import check
    from irlx.cli.output import encodable, exit_code, print_diagnostics

    worst = 0
    for program in options.programs:
        found = check(program, options.cell)
        print_diagnostics(found)
        errors = sum(diagnostic.is_error for diagnostic in found)
        words = f"{program}: {_count(errors, 'error')}, {_count(len(found) - errors, 'warning')}"
        print(encodable(words, sys.stdout))
        worst = max(worst, exit_code(found))
    return worst


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
