"""The tool Jacobian in rows of one unit."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from irlx.robot.kinematics import Kinematics
from irlx.transform.measures.jacobian_derivative import jacobian_derivative
from irlx.transform.measures.measure import Array

_ANYWHERE = pin.SE3.Identity()


def scaled_jacobian(kinematics: Kinematics, q: Array) -> Array:
    """Tool Jacobian in the tool frame at q, shape (6, n), its position rows divided by the robot's reach.

    This is the Jacobian of the robot measured in lengths of its reach, so `jacobian_derivative` of it is its
    derivative. Its singular values are the same in every frame with its origin in the tool point.
    """
    jacobian: Array = kinematics.tool_difference(q, _ANYWHERE)[1]
    jacobian[:3] /= kinematics.description.reach
    return jacobian


def task_jacobian(kinematics: Kinematics, q: Array) -> Array:
    """Rows (m, n) of `scaled_jacobian` that the robot's task asks for, in the frame of the task."""
    jacobian = scaled_jacobian(kinematics, q)
    if kinematics.task.is_whole:
        return jacobian
    if kinematics.description.task_frame is not None:
        seen = kinematics.task_frames(q[None])[0].T @ kinematics.tool_pose(q)[0]
        jacobian = _turned(seen, jacobian)
    return jacobian[list(kinematics.task.rows)]


def task_jacobian_derivative(kinematics: Kinematics, q: Array) -> tuple[Array, Array]:
    """`task_jacobian`, and its derivative by q, shape (m, n, n), joint of q last."""
    rows, description = list(kinematics.task.rows), kinematics.description
    if kinematics.coupling is None and description.task_frame is None:
        jacobian = scaled_jacobian(kinematics, q)
        slope = jacobian_derivative(jacobian)
        return (jacobian, slope) if kinematics.task.is_whole else (jacobian[rows], slope[rows])
    jacobian = kinematics.tool_motions(q)
    jacobian[:3] /= description.reach
    slope = jacobian_derivative(jacobian)
    if description.task_frame is not None:
        # Joints behind the frame turn the tool, and all that is seen from it, against the frame.
        behind = np.arange(jacobian.shape[1]) >= kinematics.body_of(description.task_frame)[0]
        turns = jacobian[3:] * behind
        for part in (slice(0, 3), slice(3, 6)):
            slope[part] += np.cross(turns.T[None], jacobian[part].T[:, None]).transpose(2, 0, 1)
        seen = kinematics.task_frames(q[None])[0].T @ kinematics.tool_pose(q)[0]
        jacobian, slope = _turned(seen, jacobian), _turned(seen, slope)
    slope = kinematics.by_axes(np.swapaxes(kinematics.by_axes(slope), 1, 2))
    return kinematics.by_axes(jacobian)[rows], np.swapaxes(slope, 1, 2)[rows]


def _turned(rotation: Array, twists: Array) -> Array:
    """Twists (6, ..) in a frame turned by a rotation (3, 3)."""
    return np.concatenate([np.tensordot(rotation, twists[:3], 1), np.tensordot(rotation, twists[3:], 1)])
