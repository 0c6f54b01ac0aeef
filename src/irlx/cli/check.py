"""`irlx check`: findings on programs, without motion."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING, Any

from irlx.cli.execution import add_execution_options, add_plugin_option, import_plugins

if TYPE_CHECKING:
    from irlx.diagnostics import Diagnostic

_EXAMPLE = """\
examples:
  irlx check programs/koch/square.irl --cell programs/koch/square.toml
  irlx check programs/koch/line.irl --motion
  irlx check programs/koch/square.irl programs/koch/line.irl --format json
"""
_FORMATS = ("text", "concise", "json", "sarif", "github")


def add_parser(commands: Any) -> None:
    """Add the command to the command line."""
    parser = commands.add_parser(
        "check",
        help="look for mistakes in programs, without running them",
        description="Look for mistakes in programs without running them; with --motion also in what moves.",
        epilog=_EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("programs", nargs="+", metavar="P.irl", help="program, module or data list files")
    parser.add_argument("--cell", metavar="C.toml", help="check this cell file, too")
    parser.add_argument(
        "--motion", action="store_true", help="also execute the programs in a dry run, at a coarse tick"
    )
    add_execution_options(parser)
    add_plugin_option(parser)
    parser.add_argument(
        "--format",
        choices=_FORMATS,
        default="text",
        help="how to print the findings (default: text, on stderr; the others go to stdout, alone)",
    )
    parser.set_defaults(command=command)


def command(options: argparse.Namespace) -> int:
    """Print the findings and, in text, a line a program on stdout; 1 where there are errors."""
    from irlx.checking import check
    from irlx.cli.output import exit_code

    import_plugins(options.plugin)
    asked = options.cell, options.motion, options.max_steps, options.inputs, options.files
    checked = [(program, check(program, *asked)) for program in options.programs]
    if options.format == "text":
        _print_text(checked)
    else:
        _print_for_machines([finding for _, found in checked for finding in found], options.format)
    return max(exit_code(found) for _, found in checked)


def _print_text(checked: list[tuple[str, list[Diagnostic]]]) -> None:
    from irlx.cli.output import encodable, print_diagnostics
    from irlx.diagnostics import Severity
    from irlx.language.words import count

    for program, found in checked:
        print_diagnostics(found)
        errors = sum(diagnostic.is_error for diagnostic in found)
        notes = sum(diagnostic.severity is Severity.INFO for diagnostic in found)
        words = f"{program}: {count(errors, 'error')}, {count(len(found) - errors - notes, 'warning')}"
        words += f", {count(notes, 'note')}" if notes else ""
        print(encodable(words, sys.stdout))


def _print_for_machines(found: list[Diagnostic], format: str) -> None:
    """What several programs share, a cell or a data list, is told once."""
    from irlx.cli.output import encodable
    from irlx.diagnostics.rendering import MACHINE_FORMATS

    text = MACHINE_FORMATS[format](list(dict.fromkeys(found)))
    if text:
        print(encodable(text, sys.stdout))
