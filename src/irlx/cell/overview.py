"""What the robots known by name are, in a line each; read without any numeric library."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from importlib.resources import files
from math import isfinite
from typing import Any

from irlx.cell.frame_names import cell_table
from irlx.cell.robot_data import robot_data_folder
from irlx.robot.description import COORDINATES, Joint, RobotDescription
from irlx.robot.urdf import read_urdf

_ROBOTS = files("irlx.cell") / "robots"
_KINDS = ("position", "speed", "acceleration")
_SENTENCE = re.compile(r"(.*?)(?:\.(?=\s|$)|[;:](?=\s)|$)", re.DOTALL)


@dataclass(frozen=True)
class RobotOverview:
    """A robot known by name.

    `slides` of its `axes` are prismatic; `limits` are the kinds that any axis has a limit of; `about` says in
    a few words what it is. Of a robot that is not `installed` slides and limits are unknown, None.
    """

    name: str
    packaged: bool
    installed: bool
    axes: int
    slides: int | None
    tip: str
    task: tuple[str, ...]
    limits: tuple[str, ...] | None
    about: str


def robot_names() -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Names of the robots packaged with irlx and of the others that a cell may name, without reading them."""
    folders = (_ROBOTS, ".urdf"), (_ROBOTS / "external", ".toml")
    packaged, others = (
        tuple(sorted(entry.name[:-5] for entry in folder.iterdir() if entry.name.endswith(ending)))
        for folder, ending in folders
    )
    return packaged, others


def robot_overviews() -> tuple[RobotOverview, ...]:
    """All robots that a cell may name, those packaged with irlx first."""
    packaged, others = robot_names()
    return (*map(_packaged, packaged), *map(_external, others))


def _packaged(name: str) -> RobotOverview:
    text = (_ROBOTS / f"{name}.urdf").read_text(encoding="utf-8")
    found = re.search(r"<!--\s*(.*?)-->", text, re.DOTALL)
    about = found[1].removeprefix(f"{name}:") if found else ""
    return _overview(name, _robot_table(_ROBOTS / f"{name}.toml"), text, about)


def _external(name: str) -> RobotOverview:
    file = _ROBOTS / "external" / f"{name}.toml"
    table, data = _robot_table(file), robot_data_folder()
    about = file.read_text(encoding="utf-8").partition("\n[")[0].replace("\n#", "").removeprefix("#")
    text = None
    if data is not None:
        try:
            text = (data / str(table.get("model"))).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError):
            # An older data package lacks some of the robots; a cell that names one is told so.
            text = None
    return _overview(name, table, text, about, packaged=False)


def _overview(
    name: str, table: Mapping[str, Any], text: str | None, about: str, packaged: bool = True
) -> RobotOverview:
    sentence = _SENTENCE.match(" ".join(about.split()))
    words = sentence[1] if sentence else ""
    # Turns that are left to the joints are not asked for.
    task = tuple(name for name in table.get("task", COORDINATES) if name not in table.get("free", ()))
    tip = str(table.get("tip", ""))
    if text is None:
        return RobotOverview(name, packaged, False, len(table.get("start", ())), None, tip, task, None, words)
    robot = read_urdf(text, table.get("tip"), dict.fromkeys(table.get("locked", {}), 0.0))
    axes = _axes(robot, table)
    slides = sum(joint.is_prismatic for joint in axes)
    limits = tuple(kind for kind in _KINDS if _is_known(kind, table.get("limits", {}), axes))
    return RobotOverview(name, packaged, True, len(axes), slides, robot.tip, task, limits, words)


def _axes(robot: RobotDescription, table: Mapping[str, Any]) -> tuple[Joint, ...]:
    """Joints that move the tip or another hand, each once."""
    ends = dict.fromkeys((robot.tip, *table.get("hands", ())))
    return tuple(dict.fromkeys(joint for end in ends for joint in replace(robot, tip=end).axes))


def _is_known(kind: str, limits: Mapping[str, Any], axes: Sequence[Joint]) -> bool:
    """Whether any axis has a limit of a kind, by the robot's own cell or its URDF."""
    if kind in limits:
        given = limits[kind]
        return isinstance(given, list) and any(entry is not False for entry in given)
    if kind == "position":
        return any(isfinite(joint.lower) or isfinite(joint.upper) for joint in axes)
    return kind == "speed" and any(isfinite(joint.speed) for joint in axes)


def _robot_table(file: Any) -> dict[str, Any]:
    table = cell_table(file).get("robot")
    return table if isinstance(table, dict) else {}
