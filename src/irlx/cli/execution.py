"""Options of the commands that execute a program: how long it may go on, and what its inputs say."""

from __future__ import annotations

import argparse

__all__ = ["add_execution_options"]


def add_execution_options(parser: argparse.ArgumentParser) -> None:
    """Add `--max-steps` and `--inputs`."""
    parser.add_argument(
        "--max-steps",
        type=int,
        metavar="N",
        help="end with IRL510 after N statements (default: 10,000,000)",
    )
    parser.add_argument(
        "--inputs", metavar="CSV", help="what inputs say: lines of time in s, input, value (else the cell's)"
    )
