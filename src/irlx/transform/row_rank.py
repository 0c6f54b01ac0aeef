"""How many coordinates of the tool pose some joints can move at all, and rows that say as much once each.

The rows of J depend on each other at single postures, which are singular, or at all of them: with its elbow
frozen, an arm whose shoulder and wrist are points cannot change the distance between the two, so that six
joints move five coordinates and one motion is left to spare. Only the second is a property of the joints.
Were both decided by the singular values of the posture at hand, motions to spare would come and go along
a way past a singular posture.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics
from irlx.transform.nearest import scaled_singular_values

Array = NDArray[np.float64]

_POSTURES = 3
_SEED = 5
_ROUNDING = 1e-11
"""Singular values below this part of the largest are rounding, the robot's own data included."""


def usual_rank(kinematics: Kinematics, q: Array, moving: NDArray[np.bool_]) -> int:
    """Rank of the columns `moving` (n,) of J at nearly all postures that leave the other joints where q is.

    The rank at a few postures drawn at random, the same ones in every run: those where it is less have no
    volume, so that none of them is met.
    """
    reach = kinematics.description.reach
    wide = np.array([reach if axis.is_prismatic else 1.0 for axis in kinematics.description.axes]) * moving
    rng = np.random.default_rng(_SEED)
    rank = 0
    for _ in range(_POSTURES if np.any(moving) else 0):
        posture = q + wide * rng.uniform(-1.0, 1.0, q.size)
        target = kinematics.target(*kinematics.tool_pose(posture))
        columns = kinematics.difference(posture, target)[1][:, moving]
        values = scaled_singular_values(columns, kinematics.row_scale)
        rank = max(rank, int(np.count_nonzero(values > _ROUNDING * values[0])))
        if rank == min(columns.shape):
            break
    return rank


def independent_rows(jacobian: Array, row_scale: Array, rank: int) -> Array:
    """P (..., rank, m) so that P J has the row space of J (..., m, n) with as many rows as its usual rank.

    The left singular vectors of the largest singular values, rows times `Kinematics.row_scale` (m,); the unit
    matrix where no row is too many. What P leaves of a pose error on the way to a pose that can be
    reached is of second order in it, so that Newton's steps of P J d = P e converge as ever.
    """
    m = jacobian.shape[-2]
    if rank >= m:
        return np.broadcast_to(np.eye(m), (*jacobian.shape[:-2], m, m))
    left = np.linalg.svd(row_scale[:, None] * jacobian, full_matrices=False)[0][..., :rank]
    return np.asarray(np.swapaxes(left, -1, -2) * row_scale)
