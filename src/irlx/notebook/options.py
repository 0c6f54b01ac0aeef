"""What may stand behind `%%irl`."""

from __future__ import annotations

from typing import Any

from IPython.core.magic_arguments import MagicArgumentParser

_DESCRIPTION = """\
Run the program in this cell and show what comes of it; the Run is the result of the cell.

Its robot is that of --robot or --cell, else of the file NAME.toml in the working folder that
SYSTEM SPECIFICATION NAME; names in the program. Data lists, modules and files are those of that folder.

example:
  %%irl --robot koch11 --name weld
  PROGRAM weld; BEGIN MOVE_INC LIN (0, 0, -100); ENDPROGRAM;
"""


def magic_parser() -> Any:
    """Parser of the options of `%%irl`; a mistake in them raises IPython's UsageError, which is one line."""
    parser: Any = MagicArgumentParser(  # type: ignore[no-untyped-call]
        "%%irl", description=_DESCRIPTION, add_help=False
    )
    robot = parser.add_mutually_exclusive_group()
    robot.add_argument("--cell", metavar="C.toml", help="cell file")
    robot.add_argument(
        "--robot", metavar="NAME", help="a robot known by name, or a URDF, in a cell with nothing else in it"
    )
    parser.add_argument("--tick", type=float, metavar="MS", help="duration of a tick (default: the cell's)")
    parser.add_argument("--name", metavar="VAR", help="variable that gets the Run as well")
    parser.add_argument(
        "--max-slow",
        type=float,
        metavar="F",
        help="end with IRL525 where limits make a move more than F times as long as programmed",
    )
    parser.add_argument("--inputs", metavar="CSV", help="what inputs say (else the cell's)")
    parser.add_argument("--files", metavar="DIR", help="folder of the program's files")
    parser.add_argument(
        "--check", action="store_true", help="only look at the text: its findings, and no robot moves"
    )
    parser.add_argument("--quiet", action="store_true", help="the cell has no result: with --name")
    return parser
