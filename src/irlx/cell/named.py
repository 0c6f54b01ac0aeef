"""Robots that a cell names instead of giving a URDF: those packaged with irlx, and those of the extra."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from irlx.cell.external import external_names, external_section, external_urdf
from irlx.cell.packaged import packaged_cell, packaged_names, packaged_urdf
from irlx.cell.read import read_cell_file
from irlx.cell.robot_data import robot_data_folder
from irlx.cell.schema import RobotSection
from irlx.diagnostics import Place


def robot_names() -> tuple[str, ...]:
    """Every name that `model` may be, the packaged robots first."""
    return packaged_names() + external_names()


@cache
def named_section(name: str) -> RobotSection:
    """What a robot of that name is by itself: tip, start, weights, limits."""
    if name in external_names():
        return external_section(name)
    return read_cell_file(packaged_cell(name), f"{name} (packaged)").robot


def named_urdf(name: str, place: Place) -> str:
    """URDF text of a robot of that name. Raises CellError, at `place`, where the extra is missing."""
    return external_urdf(name, place) if name in external_names() else packaged_urdf(name)


def urdf_folder(model: str, folder: Path) -> Path | None:
    """Folder of the URDF that a cell in `folder` names by `model`, None for a robot that comes with irlx."""
    if model in packaged_names():
        return None
    if model not in external_names():
        return (folder / model).parent
    data = robot_data_folder()
    return None if data is None else (data / (external_section(model).model or "")).parent
