"""Targets that are postures, as the poses that the tool has in them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from irlx.blocks import JointTarget, MoveBlock, PoseTarget
from irlx.robot.kinematics import Kinematics


def posed(block: MoveBlock, kinematics: Kinematics) -> MoveBlock:
    """The block of a LIN or CIRCLE with poses for target and via point."""
    course = block.course
    if course is not None:
        course = replace(course, via=_as_pose(course.via, kinematics))
    return replace(block, target=_as_pose(block.target, kinematics), course=course)


def _as_pose(target: PoseTarget | JointTarget, kinematics: Kinematics) -> PoseTarget:
    if isinstance(target, PoseTarget):
        return target
    rotation, position = kinematics.tool_pose(np.array(target.values))
    x, y, z, w = Rotation.from_matrix(rotation).as_quat()
    return PoseTarget(
        (float(position[0]), float(position[1]), float(position[2])),
        (float(x), float(y), float(z), float(w)),
    )
