"""Postures of many poses at once where no bound stands in their way: Newton steps of all of them together."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.slowdown.model import Model
from irlx.robot.pose_targets import PoseTargets
from irlx.transform.criteria.criterion import Criterion
from irlx.transform.criteria.least_motion import LeastMotion
from irlx.transform.criteria.posture import Posture

Array = NDArray[np.float64]

LONGEST = 0.5
"""Longest step of a joint (rad or m) that Newton's method is followed for."""

_ROUNDS = 8
_SETTLED = 1e-5


def references(criteria: Iterable[Criterion]) -> Array | None:
    """Postures (N, n) that a motion is drawn to; of no length for least motion; None for other criteria."""
    asked = list(criteria)
    if all(type(one) is LeastMotion for one in asked):
        return np.empty((0, 0))
    found = [one.reference for one in asked if type(one) is Posture]
    return np.array(found) if len(found) == len(asked) else None


def settle(model: Model, q: Array, targets: PoseTargets, drawn: Array) -> bool:
    """Bring postures q (N + 1, n), but the first, onto their poses and to what the criterion wants there.

    `drawn` from `references`. For least motion: each step has no part in the null space, the mean of those at
    both its ends. Whether that has led anywhere; q is changed in place.
    """
    free = model.free
    inverse, unit = 1.0 / model.weights[free], np.eye(int(np.count_nonzero(free)))
    change = np.inf
    for _ in range(_ROUNDS):
        twists, jacobians = model.differences(q, targets)
        scaled = jacobians * inverse
        gram = scaled @ np.swapaxes(jacobians, 1, 2)
        try:
            back = np.swapaxes(np.linalg.solve(gram, scaled), 1, 2)
        except np.linalg.LinAlgError:
            return False
        null = unit - back @ jacobians
        onto = (back @ twists[:, :, None])[:, :, 0]
        if len(drawn):
            step = onto[1:] + _times(null[1:], drawn[:, free] - q[1:, free])
        else:
            ways = np.diff(q[:, free], axis=0)
            step = onto[1:] - 0.5 * _times(null[1:], ways + _times(null[:-1], ways))
            for k in range(1, len(step)):
                step[k] += null[k + 1].dot(step[k - 1])
        before, change = change, float(np.max(np.abs(step)))
        if not change < min(before, LONGEST):
            return False
        q[1:, free] += step
        if change <= _SETTLED:
            return True
    return False


def _times(matrices: Array, vectors: Array) -> Array:
    """The products of matrices (N, a, b) with vectors (N, b)."""
    return np.asarray((matrices @ vectors[:, :, None])[:, :, 0])
