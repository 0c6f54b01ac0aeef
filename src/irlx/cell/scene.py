"""What stands around the robot of a cell, and which of its own links it is kept off."""

from __future__ import annotations

from irlx.cell.obstacles import read_obstacles
from irlx.cell.schema import CellFile, RobotSection
from irlx.cell.self_collision import link_clearance
from irlx.diagnostics import Diagnostic
from irlx.robot.description import RobotDescription
from irlx.scene.scene import Scene


def read_scene(
    content: CellFile,
    robot_section: RobotSection,
    robot: RobotDescription,
    file: str,
    errors: list[Diagnostic],
) -> tuple[Scene, list[Diagnostic]]:
    """Scene of a cell and the warnings on it; faults go to `errors`: IRL630 to IRL645."""
    warnings: list[Diagnostic] = []
    obstacles, groups = read_obstacles(content, file, errors, warnings)
    asked = bool(content.robot.self_collision.model_fields_set)
    links = link_clearance(robot_section, robot, file, errors, warnings, asked=asked)
    return Scene(obstacles, groups, links), warnings
