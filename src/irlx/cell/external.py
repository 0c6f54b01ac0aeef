"""Robots of the extra `robots`: a cell of our own for each, its URDF in the package example-robot-data."""

from __future__ import annotations

from functools import cache
from importlib.resources import files

from irlx.cell.errors import CellError
from irlx.cell.read import read_cell_file
from irlx.cell.robot_data import robot_data_folder
from irlx.cell.schema import RobotSection
from irlx.diagnostics import Place, report

_FOLDER = files("irlx.cell") / "robots" / "external"
_INSTALL = 'pip install "irlx[robots]"'
_UPGRADE = 'pip install --upgrade "irlx[robots]"'


@cache
def external_names() -> tuple[str, ...]:
    """Names of the robots that the extra `robots` brings, installed or not."""
    return tuple(sorted(entry.name[:-5] for entry in _FOLDER.iterdir() if entry.name.endswith(".toml")))


@cache
def external_section(name: str) -> RobotSection:
    """What irlx knows of a robot beside its URDF: tip, start, limits; `model` is the URDF in the package."""
    return read_cell_file((_FOLDER / f"{name}.toml").read_bytes(), f"{name} (irlx[robots])").robot


def external_urdf(name: str, place: Place) -> str:
    """URDF text of a robot of the data package.

    Raises CellError, IRL614, where the package is not installed or has no such robot, IRL612 where
    its file cannot be read.
    """
    folder = robot_data_folder()
    if folder is None:
        raise CellError(report("IRL614", place, model=name, cause="which is not installed", command=_INSTALL))
    file = external_section(name).model or ""
    try:
        return (folder / file).read_text(encoding="utf-8")
    except FileNotFoundError as cause:
        lacking = f"of which {folder} has no {file}"
        raise CellError(report("IRL614", place, model=name, cause=lacking, command=_UPGRADE)) from cause
    except (OSError, UnicodeDecodeError) as cause:
        raise CellError(report("IRL612", place, model=name, cause=str(cause), near="")) from cause
