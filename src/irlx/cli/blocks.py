"""`irlx blocks`: the function blocks of a program as text."""

from __future__ import annotations

import argparse
from typing import Any

from irlx.cli.execution import add_execution_options

_EXAMPLE = "example:\n  irlx blocks programs/koch/square.irl\n"


def add_parser(commands: Any) -> None:
    """Add the command to the command line."""
    parser = commands.add_parser(
        "blocks",
        help="print the function blocks of a program",
        description="Interpret a program without moving a robot, and print its function blocks.",
        epilog=_EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("program", metavar="P.irl", help="program file")
    parser.add_argument("--cell", metavar="C.toml", help="cell file (default: found beside the program)")
    add_execution_options(parser)
    parser.set_defaults(command=command)


def command(options: argparse.Namespace) -> int:
    """Print one line a block on stdout."""
    from irlx.blocks.text import block_text
    from irlx.cli.output import print_diagnostics
    from irlx.pipeline import Execution, header_of, prepare

    job = prepare(options.program, options.cell, max_steps=options.max_steps, inputs=options.inputs)
    print_diagnostics(job.program.diagnostics)
    units = header_of(job).joint_units
    for block in Execution(job).blocks():
        print(block_text(block, units))
    return 0
