"""A robot by itself, before anybody has written a cell for it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from irlx.cell.build import limits_of
from irlx.cell.errors import CellError
from irlx.cell.model import load_robot, with_packaged_defaults, without_absent_joints
from irlx.cell.named import robot_names
from irlx.cell.schema import RobotSection
from irlx.diagnostics import Diagnostic
from irlx.robot.description import COORDINATES, RobotDescription
from irlx.robot.limits import JointLimits
from irlx.robot.urdf import read_urdf


@dataclass(frozen=True)
class BareRobot:
    """A robot with the limits of its URDF, or its own where it has a name; `start` in deg | mm, if any."""

    robot: RobotDescription
    limits: JointLimits
    start: tuple[float, ...] | None
    section: RobotSection

    @property
    def has_name(self) -> bool:
        """Whether irlx knows it by name."""
        return self.section.model in robot_names()


def bare_robot(model: str, tip: str | None = None, folder: Path | None = None) -> BareRobot:
    """The robot of that name, or of the URDF at that path from `folder`.

    Its task is the named robot's; of a URDF with fewer axes than a pose has coordinates it is what the joints
    move, if that is no more. Raises CellError as `load_cell` does.
    """
    given: dict[str, Any] = {"model": model} if tip is None else {"model": model, "tip": tip}
    asked = RobotSection(**given)
    folder = folder or Path()
    if model not in robot_names():
        task = _moved_coordinates(asked, folder)
        asked = asked if task is None else asked.model_copy(update={"task": task})
    section = with_packaged_defaults(asked)
    robot = load_robot(section, model, folder)
    section = without_absent_joints(section, asked, robot)
    errors: list[Diagnostic] = []
    limits = limits_of(section.limits, robot, model, errors)
    if errors:
        raise CellError(errors)
    return BareRobot(robot, limits, None if section.start is None else tuple(section.start), section)


def _moved_coordinates(asked: RobotSection, folder: Path) -> list[str] | None:
    """Coordinates of the tool pose that the joints move, None where these are all, or more than the joints.

    None as well for a URDF that cannot be used: what is wrong with it is told when it is loaded.
    """
    try:
        robot = read_urdf((folder / (asked.model or "")).read_text(encoding="utf-8"), asked.tip)
    except (OSError, ValueError):
        return None
    # One joint alone makes no robot: Pinocchio gives its Jacobian as a vector.
    if not 1 < len(robot.axes) < len(COORDINATES):
        return None
    # Imported here: robots with enough axes are told of without Pinocchio.
    from irlx.robot.kinematics import Kinematics

    fixed = Kinematics(replace(robot, coordinates=())).immovable.coordinates
    moved = [name for name in COORDINATES if name not in fixed]
    return moved if 0 < len(moved) <= len(robot.axes) else None
