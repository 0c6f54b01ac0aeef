"""Poses that targets of moves stand for."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.blocks import PoseTarget, Target

Array = NDArray[np.float64]


def target_pose(target: Target, start_rotation: Array) -> tuple[Array, Array]:
    """Rotation (3, 3) and position (3,) m of a pose target; one without orientation keeps that of the start.

    Postures and increments become poses where the robot is known, before a path is planned: TypeError here.
    """
    if not isinstance(target, PoseTarget):
        raise TypeError("a path is planned to poses, not to joint values or increments")
    rotation = start_rotation
    if target.orientation is not None:
        rotation = np.asarray(Rotation.from_quat(target.orientation).as_matrix())
    return rotation, np.array(target.position)
