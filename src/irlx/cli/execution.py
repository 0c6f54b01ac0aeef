"""Options of the commands that execute a program: how long it may go on, what its inputs say, its files."""

from __future__ import annotations

import argparse
import sys
from typing import IO

__all__ = ["add_execution_options", "add_plugin_option", "import_plugins", "standard_input"]


def add_execution_options(parser: argparse.ArgumentParser) -> None:
    """Add `--max-steps`, `--inputs` and `--files`."""
    parser.add_argument(
        "--max-steps",
        type=int,
        metavar="N",
        help="end with IRL510 after N statements (default: 10,000,000)",
    )
    parser.add_argument(
        "--inputs",
        metavar="CSV",
        help="what inputs say: lines of time in s, input, value (what it lacks: as in the cell)",
    )
    parser.add_argument(
        "--files", metavar="DIR", help="folder in which OPEN finds and makes files (default: the program's)"
    )


def add_plugin_option(parser: argparse.ArgumentParser) -> None:
    """Add `--plugin`."""
    parser.add_argument(
        "--plugin",
        action="append",
        default=[],
        metavar="M",
        help="import a module or a .py file that registers criteria or constraints; may be repeated",
    )


def import_plugins(names: list[str]) -> None:
    """Import what `--plugin` names. Raises IrlxError, IRL009, for one that cannot be imported."""
    for name in names:
        from irlx.cli.plugin import import_plugin

        import_plugin(name)


def standard_input() -> IO[bytes] | None:
    """What STANDARD_IN reads on the command line."""
    return None if sys.stdin is None else sys.stdin.buffer
