"""A robot by itself, before anybody has written a cell for it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from irlx.cell.build import limits_of
from irlx.cell.errors import CellError
from irlx.cell.model import load_robot, with_packaged_defaults, without_absent_joints
from irlx.cell.named import robot_names
from irlx.cell.schema import RobotSection
from irlx.diagnostics import Diagnostic
from irlx.diagnostics.whole_file import whole_text
from irlx.robot.description import COORDINATES, RobotDescription
from irlx.robot.limits import JointLimits
from irlx.robot.urdf import read_urdf

if TYPE_CHECKING:
    from irlx.cell.suggested_task import SuggestedTask


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

    Its task is the named robot's; of a URDF with fewer axes than a pose has coordinates that of
    `suggested_task`. Raises CellError as `load_cell` does.
    """
    given: dict[str, Any] = {"model": model} if tip is None else {"model": model, "tip": tip}
    asked = RobotSection(**given)
    folder = folder or Path()
    if model not in robot_names():
        task = _suggested(asked, folder)
        if task is not None:
            update = {"task": list(task.coordinates), "task_frame": task.frame, "free": list(task.free)}
            asked = asked.model_copy(update=update)
    section = with_packaged_defaults(asked)
    robot = load_robot(section, model, folder)
    section = without_absent_joints(section, asked, robot)
    errors: list[Diagnostic] = []
    limits = limits_of(section.limits, robot, model, errors)
    if errors:
        raise CellError(errors)
    return BareRobot(robot, limits, None if section.start is None else tuple(section.start), section)


def _suggested(asked: RobotSection, folder: Path) -> SuggestedTask | None:
    """A task for a URDF with few axes; None where it needs none, and where there is none.

    None as well for a URDF that cannot be used: what is wrong with it is told when it is loaded.
    """
    try:
        robot = read_urdf(whole_text(folder / (asked.model or "")), asked.tip)
    except (OSError, ValueError):
        return None
    if not 0 < len(robot.axes) < len(COORDINATES):
        return None
    # Imported here: robots with enough axes are told of without Pinocchio.
    from irlx.cell.suggested_task import suggested_task

    return suggested_task(robot)
