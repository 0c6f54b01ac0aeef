"""A robot without any shapes as sticks between its joints."""

from __future__ import annotations

from collections.abc import Mapping
from math import acos, atan2, isfinite, sqrt

from irlx.report.appearance.model import Part
from irlx.robot.description import Joint, RobotDescription
from irlx.solids.placement import Placement, Vector3
from irlx.solids.shape import Cylinder, Sphere

_STICK = 0.012
"""Radius of a stick as a share of the robot's reach, and of ..."""
_BALL = 0.02
"""... the ball at a joint; along the way of a slide lies .."""
_RAIL = 0.006
"""... a stick of this radius."""


def stick_figure(robot: RobotDescription) -> dict[str, list[Part]]:
    """Parts by link: a stick from its frame to that of each joint on it, a ball where one moves.

    A slide that moves within limits has a thin stick along its way.
    """
    found: dict[str, list[Part]] = {}
    size = robot.reach
    for joint in robot.joints:
        on_parent = found.setdefault(joint.parent, [])
        on_parent += stick((0.0, 0.0, 0.0), joint.xyz, _STICK * size)
        if joint not in robot.moving:
            continue
        if joint.is_prismatic:
            on_parent += _rail(joint, _RAIL * size)
        else:
            found.setdefault(joint.child, []).append(Part(Sphere(_BALL * size)))
    return found


def moved_joints(robot: RobotDescription, moved_from: Mapping[str, Vector3]) -> dict[str, list[Part]]:
    """Sticks by link to the joints that a cell has moved, from where the shapes of the model expect them."""
    found: dict[str, list[Part]] = {}
    for joint in robot.joints:
        if joint.name in moved_from:
            way = stick(moved_from[joint.name], joint.xyz, _STICK * robot.reach)
            found.setdefault(joint.parent, []).extend(way)
    return found


def stick(start: Vector3, end: Vector3, radius: float) -> list[Part]:
    """A cylinder between two points of a frame; none where they are one."""
    way = [b - a for a, b in zip(start, end, strict=True)]
    length = sqrt(sum(part * part for part in way))
    if length <= radius:
        return []
    x, y, z = (a + 0.5 * part for a, part in zip(start, way, strict=True))
    # Turned about y by the angle between the way and z, then about z by that of its shadow.
    turn = (0.0, acos(max(-1.0, min(1.0, way[2] / length))), atan2(way[1], way[0]))
    return [Part(Cylinder(radius, length), Placement.from_rpy((x, y, z), turn))]


def _rail(joint: Joint, radius: float) -> list[Part]:
    if not (isfinite(joint.lower) and isfinite(joint.upper)):
        return []
    frame = Placement.from_rpy(joint.xyz, joint.rpy)
    x, y, z = joint.axis
    lower, upper = (Placement((x * end, y * end, z * end)) for end in (joint.lower, joint.upper))
    return stick(frame.of(lower).position, frame.of(upper).position, radius)
