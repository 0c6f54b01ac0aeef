"""`irlx fmt`: programs in irlx's form."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

_EXAMPLE = """\
examples:
  irlx fmt programs/koch/square.irl
  irlx fmt --check programs/koch/square.irl programs/combined/points.dat
  irlx fmt --diff programs/koch/line.irl
"""
_STANDARD_INPUT = "-"


def add_parser(commands: Any) -> None:
    """Add the command to the command line."""
    parser = commands.add_parser(
        "fmt",
        help="bring programs into irlx's form",
        description="Format programs, modules and data lists in place, and mend what irlx only forgives.",
        epilog=_EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("programs", nargs="+", metavar="FILE", help="file; - reads stdin and writes stdout")
    parser.add_argument(
        "--check", action="store_true", help="write nothing; exit code 1 where a file would change"
    )
    parser.add_argument("--diff", action="store_true", help="write nothing; print what would change")
    parser.set_defaults(command=command)


def command(options: argparse.Namespace) -> int:
    """Format each file; those with errors are left alone and reported. 1 where --check finds changes."""
    from irlx.cli.output import exit_code, print_diagnostics
    from irlx.diagnostics import IrlxError

    worst = 0
    for name in options.programs:
        try:
            changed = _format(name, options)
        except IrlxError as error:
            print_diagnostics(error.diagnostics)
            worst = max(worst, exit_code(error.diagnostics))
        else:
            worst = max(worst, int(changed and options.check))
    return worst


def _format(name: str, options: argparse.Namespace) -> bool:
    """Format one file; whether that changes it. Raises IrlxError where it cannot be formatted."""
    from irlx.cli.output import encodable
    from irlx.language.format import format_source
    from irlx.language.source import decode_source
    from irlx.program import names_around

    path, shown = Path(name), "<stdin>" if name == _STANDARD_INPUT else name
    content = sys.stdin.buffer.read() if name == _STANDARD_INPUT else _read(path)
    text = decode_source(shown, content).text
    around = (None, None) if name == _STANDARD_INPUT else names_around(path)
    formatted = format_source(text, shown, *around)
    new = formatted.encode("utf-8")
    changed = new != content
    if options.diff:
        sys.stdout.writelines(encodable(line, sys.stdout) for line in _difference(shown, text, formatted))
    elif name == _STANDARD_INPUT and not options.check:
        sys.stdout.flush()
        sys.stdout.buffer.write(new)
    elif changed:
        if not options.check:
            from irlx.cli.replacing import replace_content

            replace_content(path, new)
        words = f"{shown}: {'would be formatted' if options.check else 'formatted'}"
        print(encodable(words, sys.stdout))
    return changed


def _read(path: Path) -> bytes:
    from irlx.program import read_file

    return read_file(path)


def _difference(name: str, old: str, new: str) -> Iterator[str]:
    from difflib import unified_diff

    lines = unified_diff(old.splitlines(True), new.splitlines(True), name, f"{name} (formatted)")
    for line in lines:
        yield line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n"
