"""`irlx verify`: independent check of a written stream."""

from __future__ import annotations

import argparse
import sys
from typing import Any

_EXAMPLE = "examples:\n  irlx verify programs/koch/square.irdata --program programs/koch/square.irl\n"


def add_parser(commands: Any) -> None:
    """Add the command to the command line."""
    parser = commands.add_parser(
        "verify",
        help="check a written joint stream independently",
        description="Check a written joint stream: checksum, blocks, limits by differences, paths, goals.",
        epilog=_EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "stream", metavar="OUT", help="stream: .irdata, .npz, .jsonl, .csv, .parquet, .rosbag"
    )
    parser.add_argument("--cell", metavar="C.toml", help="cell file with the robot (default: as recorded)")
    parser.add_argument(
        "--program", metavar="P.irl", help="require that the stream's blocks are those of this program"
    )
    parser.add_argument(
        "--max-steps", type=int, metavar="N", help="with --program: as it was run with (default: 10,000,000)"
    )
    parser.add_argument("--json", action="store_true", help="print the report as JSON")
    parser.set_defaults(command=command)


def command(options: argparse.Namespace) -> int:
    """Print the table of checks on stdout; 1 where one fails."""
    import json

    from irlx.cli.output import encodable, print_lines
    from irlx.report.lines import Line, Tone
    from irlx.verification import verify

    report = verify(options.stream, options.program, options.cell, options.max_steps)
    if options.json:
        print(encodable(json.dumps(report.to_plain(), indent=2), sys.stdout))
    else:
        *table, verdict = str(report).splitlines()
        told = Line(None, verdict, Tone.GOOD if report.passed else Tone.BAD)
        print_lines([*(Line(None, words) for words in table), told])
    return 0 if report.passed else 1
