"""The tool Jacobian in rows of one unit."""

from __future__ import annotations

import pinocchio as pin

from irlx.robot.kinematics import Kinematics
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


def of_task(kinematics: Kinematics, jacobian: Array) -> Array:
    """Rows of a tool Jacobian (6, n), or of its derivative (6, n, n), that the robot's task asks for."""
    return jacobian if kinematics.task.is_whole else jacobian[list(kinematics.task.rows)]
