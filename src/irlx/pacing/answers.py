"""Answers to questions of the interpreter that need nothing but plain data or the robot's model."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.blocks import AskManipulability, AskPose
from irlx.pacing.rows import MotionRows
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.transform.measures.manipulability import Manipulability

Array = NDArray[np.float64]


def answer_of_posture(question: AskPose | AskManipulability, kinematics: Kinematics) -> tuple[float, ...]:
    """The tool pose of a posture as position, m, and quaternion x, y, z, w; or its manipulability."""
    q = np.array(question.posture)
    if isinstance(question, AskManipulability):
        return (float(Manipulability(kinematics).value(q)),)
    rotation, position = kinematics.tool_pose(q)
    return (*position.tolist(), *Rotation.from_matrix(rotation).as_quat().tolist())


def answer_of_bounds(limits: JointLimits) -> tuple[float, ...]:
    """All lower position bounds in force, then all upper ones, rad or m."""
    lower, upper = limits.pair("position")
    return (*lower.tolist(), *upper.tolist())


def answer_of_last_move(duration: float, length: float) -> tuple[float, ...]:
    """Duration (s), and the way (m) behind and before the robot that stands at the end of a move."""
    return duration, length, 0.0


def way_of(rows: MotionRows | None, start: Array, dt: float) -> tuple[float, float]:
    """Duration (s) and length (m) of the way of the tool in the rows of a move from `start` (3,) m.

    The length is that of the path where it was programmed, of a PTP the sum from row to row.
    """
    if rows is None:
        return 0.0, 0.0
    duration = (rows.ticks - rows.stops) * dt
    if rows.path is not None and not rows.path.is_turn:
        return duration, float(rows.length)
    steps = np.diff(rows.tool_position, axis=0, prepend=start[None])
    return duration, float(np.sum(np.linalg.norm(steps, axis=1)))
