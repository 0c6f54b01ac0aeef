"""Answers to questions about a posture that need nothing but the robot's model."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from irlx.blocks import AskManipulability, AskPose
from irlx.robot.kinematics import Kinematics
from irlx.transform.measures.manipulability import Manipulability


def answer_of_posture(question: AskPose | AskManipulability, kinematics: Kinematics) -> tuple[float, ...]:
    """The tool pose of a posture as position, m, and quaternion x, y, z, w; or its manipulability."""
    q = np.array(question.posture)
    if isinstance(question, AskManipulability):
        return (float(Manipulability(kinematics).value(q)),)
    rotation, position = kinematics.tool_pose(q)
    return (*position.tolist(), *Rotation.from_matrix(rotation).as_quat().tolist())
