"""A correction as six numbers: the pose of the corrected tool in the programmed tool frame.

dx, dy, dz in m say where it is, rx, ry, rz in rad how it is turned, as a rotation vector.
"""

from __future__ import annotations

from math import hypot

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

Array = NDArray[np.float64]


def corrected_pose(rotation: Array, position: Array, correction: Array) -> pin.SE3:
    """Pose in the world of a tool programmed at `rotation` (3, 3), `position` (3,) m, and corrected (6,)."""
    turn = pin.exp3(correction[3:])
    return pin.SE3(rotation @ turn, position + rotation @ correction[:3])


def correction_between(rotation: Array, position: Array, pose: tuple[Array, Array]) -> Array:
    """Correction (6,) that leads from the programmed pose to `pose`, rotation (3, 3) and position (3,) m."""
    away = rotation.T @ (pose[1] - position)
    return np.concatenate([away, pin.log3(rotation.T @ pose[0])])


def twist_of_rate(correction: Array) -> Array:
    """Matrix (6, 6) from the rate of a correction to the twist of the tool, in the tool frame."""
    found = np.zeros((6, 6))
    found[:3, :3] = pin.exp3(correction[3:]).T
    found[3:, 3:] = pin.Jexp3(correction[3:])
    return found


def parts(correction: Array) -> tuple[float, float]:
    """Length of the displacement, m, and of the rotation vector, rad."""
    return hypot(*correction[:3].tolist()), hypot(*correction[3:].tolist())
