"""Geometry of CIRCLE: the arc that a move block and the actual pose describe, or why there is none."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import ArcCourse, MoveBlock
from irlx.diagnostics import Place, report, told_apart
from irlx.motion.arc import NEAREST_POINTS, Arc, Circle, spread
from irlx.motion.errors import MotionError
from irlx.motion.target_pose import target_pose
from irlx.motion.turn import Turn, Turning, TurnsThroughVia

Array = NDArray[np.float64]


def circle_path(block: MoveBlock, start_rotation: Array, start_position: Array, place: Place) -> Arc:
    """Arc from the actual pose (rotation (3, 3), position (3,) m, world) through via and end point.

    With ANGLE the travel is that angle, backwards where it is negative, and the end point gives the plane
    only. Raises MotionError: IRL427 for points that coincide, IRL428 for points on a line, IRL429 where
    the via orientation counts and the travel does not come to it.
    """
    course = block.arc
    if course is None:
        raise TypeError("a CIRCLE has a course")
    via_rotation, via = target_pose(course.via, start_rotation)
    end_rotation, end = target_pose(block.target, start_rotation)
    _check_points(start_position, via, end, place)
    circle = Circle.through(start_position, via, end)
    travel = circle.end_angle
    if course.angle is not None:
        circle = circle if course.angle > 0.0 else circle.reversed
        travel = abs(course.angle)
        end = circle.point_after(travel)
    orientation: Turning = Turn(start_rotation, end_rotation)
    if course.turns_through_via:
        via_share = _via_share(circle, travel, course, place)
        orientation = TurnsThroughVia(
            Turn(start_rotation, via_rotation), Turn(via_rotation, end_rotation), via_share
        )
    return Arc(circle, travel, end, end_rotation, orientation)


def _check_points(start: Array, via: Array, end: Array, place: Place) -> None:
    apart = spread(start, via, end)
    named = {
        "start and via point": apart.start_via,
        "via and end point": apart.via_end,
        "start and end point": apart.start_end,
    }
    for points, distance in named.items():
        if distance < NEAREST_POINTS:
            raise MotionError(report("IRL427", place, points=points, distance=_millimetres(distance)))
    if apart.height < NEAREST_POINTS:
        raise MotionError(report("IRL428", place, height=_millimetres(apart.height)))


def _via_share(circle: Circle, travel: float, course: ArcCourse, place: Place) -> float:
    """Share of the travel at which the via point is passed for the first time."""
    share = circle.share_at_via(travel)
    if share is None:
        asked = course.angle if course.angle is not None else travel
        angle, via = told_apart(float(np.degrees(asked)), float(np.degrees(circle.via_angle)))
        raise MotionError(report("IRL429", place, angle=angle, via=via))
    return share


def _millimetres(metres: float) -> str:
    return f"{metres * 1000.0:.3g}"
