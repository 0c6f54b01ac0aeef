"""`irlx explain`: what a code means, with a bad and a repaired program."""

from __future__ import annotations

import argparse
import sys
from typing import Any

_EXAMPLE = "examples:\n  irlx explain IRL203\n  irlx explain --list\n"


def add_parser(commands: Any) -> None:
    """Add the command to the command line."""
    parser = commands.add_parser(
        "explain",
        help="tell what a code of a message means",
        description="Print the page of a code: what it means, a program that has it, and how to repair it.",
        epilog=_EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("code", nargs="?", metavar="CODE", help="for example IRL203 (default: list all)")
    parser.add_argument("--list", action="store_true", help="list all codes, one a line")
    parser.set_defaults(command=command)


def command(options: argparse.Namespace) -> int:
    """Print a page, or one line a code. Raises IrlxError, IRL006, for what is no code."""
    from irlx.cli.output import coloured, encodable
    from irlx.diagnostics.pages import page_text

    if options.list or options.code is None:
        print(encodable(_list(), sys.stdout))
        return 0
    page = page_text(_known(options.code))
    if coloured(sys.stdout):
        # Imported here: what reads a pipe wants the page as it is, at once.
        from rich.console import Console
        from rich.markdown import Markdown

        Console().print(Markdown(page))
    else:
        print(encodable(page.rstrip("\n"), sys.stdout))
    return 0


def _list() -> str:
    from irlx.diagnostics import CATALOGUE
    from irlx.diagnostics.pages import page_title

    return "\n".join(
        f"{code}  {CATALOGUE[code].severity.value:<8} {page_title(code)}" for code in sorted(CATALOGUE)
    )


def _known(asked: str) -> str:
    """The code as the catalogue writes it; the letters may be left out."""
    from irlx.diagnostics import CATALOGUE, IrlxError, report
    from irlx.diagnostics.diagnostic import near_matches

    code = asked.strip().upper()
    for spelling in (code, f"IRL{code}"):
        if spelling in CATALOGUE:
            return spelling
    cause = "there is no such code" + near_matches(code, sorted(CATALOGUE))
    raise IrlxError(report("IRL006", option="explain", value=asked, cause=cause))
