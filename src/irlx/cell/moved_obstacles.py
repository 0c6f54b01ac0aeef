"""A cell with its obstacles put elsewhere, and the text that its file would have for them."""

from __future__ import annotations

import json
import warnings
from collections.abc import Mapping
from dataclasses import replace
from math import isfinite
from pathlib import Path
from unicodedata import normalize

from scipy.spatial.transform import Rotation

from irlx.cell.cell import Cell
from irlx.cell.errors import CellError
from irlx.cell.findings import Findings
from irlx.cell.obstacles import Frames, base_of, read_obstacles
from irlx.cell.read import read_cell_file
from irlx.cell.schema import CellFile, ObstacleSection, WaypointSection
from irlx.diagnostics import Diagnostic
from irlx.diagnostics.whole_file import whole_file
from irlx.solids.placement import Placement

_DIGITS_MM, _DIGITS_DEG = 1, 2
"""Decimals of what is moved by hand: a tenth of a mm, a hundredth of a degree."""


class MovableObstacles:
    """The obstacles of a cell as its file has them, and what becomes of the cell where some are moved.

    Where a hand puts them is rounded to 0.1 mm and 0.01 degrees in the frame that the file places them in, so
    that the text says exactly what runs. What moves by itself cannot be moved.
    """

    def __init__(self, cell: Cell) -> None:
        self._cell, self._content = cell, _content(cell)
        sections = self._content.frames.items()
        self._frames: Frames = {name.casefold(): (name, section) for name, section in sections}

    @property
    def names(self) -> tuple[str, ...]:
        """Names, as the file writes them, of the obstacles that stand still."""
        named = (section for section in self._content.obstacle if section.shape != "group")
        return tuple(normalize("NFC", section.name) for section in named if not section.trajectory)

    def moved(self, poses: Mapping[str, Placement]) -> Cell:
        """The cell with obstacles by name at poses in the world; KeyError for a name that is none."""
        if not poses:
            return self._cell
        content = self._content.model_copy(update={"obstacle": self._sections(poses)})
        errors: list[Diagnostic] = []
        obstacles, _ = read_obstacles(content, self._cell.file, errors, [])
        if errors:
            raise CellError(errors)
        return replace(self._cell, scene=replace(self._cell.scene, obstacles=obstacles))

    def text(self, poses: Mapping[str, Placement]) -> str:
        """All `[[obstacle]]` tables of the file as TOML, those of `poses` where they are now."""
        return "\n".join(_table(section) for section in self._sections(poses))

    def _sections(self, poses: Mapping[str, Placement]) -> list[ObstacleSection]:
        unknown = sorted(set(poses) - set(self.names))
        if unknown:
            raise KeyError(unknown[0])
        found = {normalize("NFC", section.name): section for section in self._content.obstacle}
        moved = {name: self._at(found[name], pose) for name, pose in poses.items()}
        return [moved.get(name, section) for name, section in found.items()]

    def _at(self, section: ObstacleSection, pose: Placement) -> ObstacleSection:
        """The table of an obstacle that lies at a pose in the world."""
        findings = Findings(self._cell.file, "obstacle", [])
        base = base_of(section, self._frames, findings)
        turn = Rotation.from_quat(base.orientation).inv()
        away = [a - b for a, b in zip(pose.position, base.position, strict=True)]
        xyz = [round(float(value) * 1e3, _DIGITS_MM) + 0.0 for value in turn.apply(away)]
        with warnings.catch_warnings():
            # Upright by 90 degrees, two of the turns are about one axis: any split of them will do.
            warnings.simplefilter("ignore", UserWarning)
            turns = (turn * Rotation.from_quat(pose.orientation)).as_euler("xyz", degrees=True)
        rpy = [round(float(value), _DIGITS_DEG) + 0.0 for value in turns]
        return section.model_copy(update={"xyz": xyz, "rpy": rpy})


def _content(cell: Cell) -> CellFile:
    """What the file of a cell holds; nothing where the cell is not from a file, or that is gone."""
    if not cell.scene.obstacles:
        return CellFile()
    try:
        return read_cell_file(whole_file(Path(cell.file)), cell.file)
    except (OSError, CellError):
        return CellFile()


def _table(section: ObstacleSection) -> str:
    return "\n".join(("[[obstacle]]", *_entries(section), ""))


def _entries(section: ObstacleSection | WaypointSection) -> list[str]:
    """What the file gives of a table, in the order of the schema."""
    given = section.model_fields_set
    values = ((name, getattr(section, name)) for name in type(section).model_fields if name in given)
    return [f"{name} = {_value(value)}" for name, value in values if value is not None]


def _value(value: object) -> str:
    """A value of an obstacle's table as TOML."""
    if isinstance(value, str):
        # What JSON escapes TOML reads alike, but for DEL, which TOML wants escaped.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, WaypointSection):
        return f"{{ {', '.join(_entries(value))} }}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, float) and isfinite(value) and value == int(value) and abs(value) < 1e15:
        return str(int(value))
    return repr(value)
