"""`irlx blocks`: the function blocks of a program as text."""

from __future__ import annotations

import argparse
import sys
from typing import Any

from irlx.cli.execution import add_execution_options, standard_input

_EXAMPLE = "examples:\n  irlx blocks programs/koch/square.irl\n"


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
    """Print one line a block, and one for each text that is written, on stdout; no file is written."""
    from irlx.blocks.text import block_text
    from irlx.cli.output import print_diagnostics
    from irlx.job import header_of, prepare
    from irlx.pipeline import Execution

    job = prepare(
        options.program,
        options.cell,
        max_steps=options.max_steps,
        inputs=options.inputs,
        files=options.files,
        input=standard_input(),
    )
    print_diagnostics(job.program.diagnostics)
    units = header_of(job).joint_units
    execution = Execution(job)
    for block in execution.blocks(_print_written):
        print(block_text(block, units))
    print_diagnostics(execution.left_open)
    return 0


def _print_written(name: str | None, text: str) -> None:
    """A line for what the program writes, at the place where a run would write it."""
    import json

    from irlx.cli.output import encodable

    file = f"'{name}' " if name is not None else ""
    print(encodable(f"  WRITE {file}{json.dumps(text, ensure_ascii=False)}", sys.stdout))
