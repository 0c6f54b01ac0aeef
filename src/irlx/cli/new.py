"""`irlx new`: a cell and a first program for a robot."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from irlx.first_program import FirstProgram

_EXAMPLE = """\
examples:
  irlx new first --robot planar3
  irlx new weld --urdf src/irlx/cell/robots/arm7.urdf --tip tool
"""


def add_parser(commands: Any) -> None:
    """Add the command to the command line."""
    parser = commands.add_parser(
        "new",
        help="write a cell and a first program for a robot",
        description="Write NAME.toml, a commented cell, and NAME.irl, a program that runs on the robot.",
        epilog=_EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "name", metavar="NAME", help="name of the program and its files, with a folder or not"
    )
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument("--urdf", metavar="F.urdf", help="robot by its URDF, which stays where it is")
    which.add_argument("--robot", metavar="ROBOT", help="robot by name; irlx robots lists them")
    parser.add_argument("--tip", metavar="LINK", help="the link that programs move (default: the only end)")
    parser.add_argument("--force", action="store_true", help="replace files that are there")
    parser.set_defaults(command=command)


def command(options: argparse.Namespace) -> int:
    """Write both files; what to do next goes to stdout."""
    cell, program = _files(options.name, options.force)
    model = _model(options)
    from irlx.cli.output import encodable, print_diagnostics
    from irlx.cli.progress import shown_status

    with shown_status("looking for first moves"):
        from irlx.first_program import first_program

        found = first_program(program.stem, model, options.tip, cell.parent)
    write_text(cell, found.cell)
    write_text(program, found.program)
    if found.warning is not None:
        print_diagnostics((found.warning,))
    print(encodable(_told(found, cell, program, model), sys.stdout))
    return 0


def _told(found: FirstProgram, cell: Path, program: Path, model: str) -> str:
    robot = found.bare.robot
    tried = f"tried, {found.duration:.4g} s, {found.checks} checks passed" if found.checks else "not tried"
    if found.checks and found.bare.has_name and not found.watched:
        tried += ", without self-collision for its meshes"
    moves = "1 move" if found.moves == 1 else f"{found.moves} moves"
    check = (
        f"irlx robots {model}" if found.bare.has_name else f"irlx robots --check {model} --tip {robot.tip}"
    )
    return "\n".join(
        [
            f"{'written':<12}{cell}: {model}, {len(robot.axes)} axes, tip '{robot.tip}'",
            f"{'written':<12}{program}: {moves}; {tried}",
            f"{'next':<12}irlx run {program}",
            f"{'next':<12}put what is known into {cell}; {check}",
        ]
    )


def _files(name: str, force: bool) -> tuple[Path, Path]:
    """Cell and program. Raises IrlxError: IRL006 for what can be no name, IRL669 for files that are there."""
    from irlx.diagnostics import IrlxError, report
    from irlx.language.keywords import is_name

    path = Path(name)
    path = path.with_suffix("") if path.suffix in (".irl", ".toml") else path
    if not is_name(path.name):
        cause = "a program needs a name of letters, digits and _ that begins with a letter and is no keyword"
        raise IrlxError(report("IRL006", option="new", value=name, cause=cause))
    files = path.with_name(f"{path.name}.toml"), path.with_name(f"{path.name}.irl")
    there = [file for file in files if os.path.lexists(file)]
    if there and not force:
        raise IrlxError([report("IRL669", path=file) for file in there])
    return files


def _model(options: argparse.Namespace) -> str:
    """What a cell calls the robot. Raises IrlxError, IRL006, for a robot by name that is none."""
    if options.urdf is not None:
        given = str(options.urdf)
        # A name without a folder or an ending would be looked for among the robots known by name.
        return given if "/" in given or "." in given else f"./{given}"
    return known_robot(options.robot)


def known_robot(name: str) -> str:
    """The name of a robot that irlx knows. Raises IrlxError, IRL006, for any other."""
    from irlx.cell.overview import robot_names
    from irlx.diagnostics import IrlxError, report
    from irlx.diagnostics.diagnostic import near_matches

    names = tuple(known for group in robot_names() for known in group)
    if name not in names:
        cause = f"no robot has this name{near_matches(name, names)}"
        helps = "irlx robots lists all names"
        raise IrlxError(report("IRL006", option="--robot", value=name, cause=cause, help=helps))
    return name


def write_text(path: Path, text: str) -> None:
    """Write a file. Raises IrlxError, IRL003."""
    from irlx.cli.replacing import replace_content

    replace_content(path, text.encode("utf-8"))
