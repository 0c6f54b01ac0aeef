"""`irlx convert`: a stream in another format, or as a program of a controller."""

from __future__ import annotations

import argparse
import sys
from typing import Any

_EXAMPLE = """\
examples:
  irlx convert programs/koch/square.irdata -o square.npz -o square.jsonl
  irlx convert programs/koch/square.irdata -o square.src
  irlx convert programs/koch/square.irdata -o square_robodk.csv --to robodk
"""
_TARGETS = ("urscript", "krl", "rapid", "robodk")
"""Those of `irlx.exporters`, whose numeric libraries the help does without."""


def add_parser(commands: Any) -> None:
    """Add the command to the command line."""
    parser = commands.add_parser(
        "convert",
        help="write a stream in another format, or as a program of a controller",
        description="Write a joint stream in another format, or as a program of a controller.",
        epilog=_EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("stream", metavar="IN", help="stream: .irdata, .npz, .jsonl, .csv, .parquet, .rosbag")
    parser.add_argument(
        "-o",
        "--output",
        action="append",
        required=True,
        metavar="OUT",
        help="what to write, format by its ending: .irdata, .npz, .jsonl, .csv, .parquet, .rosbag, or for "
        "controllers .script (URScript), .src (KRL), .mod (RAPID); may be given several times",
    )
    parser.add_argument(
        "--to", choices=_TARGETS, help="what to write, whatever the ending says; RoboDK CSV needs it"
    )
    parser.add_argument(
        "--incomplete",
        action="store_true",
        help="make a program also of a stream that did not come to its end",
    )
    parser.set_defaults(command=command)


def command(options: argparse.Namespace) -> int:
    """Write the files, say on stdout which, and on stderr what they lack."""
    from irlx.cli.output import encodable, print_diagnostics
    from irlx.conversion import convert

    print_diagnostics(convert(options.stream, options.output, options.to, options.incomplete))
    for path in options.output:
        print(encodable(f"{'written':<12}{path}", sys.stdout))
    return 0
