"""Whether joints swing, as a criterion can make them that asks for one thing here, another one there."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]

_HARDLY = 0.1
_SLOWEST = 0.05
_FAST = 1.0
_MOST_TURNS = 12
_MOST_IN_TURN = 4


def swings(q: Array, limits: JointLimits, dt: float) -> bool:
    """Whether a joint is accelerated to and fro over and over in rows q (N, n), dt s apart, rest to rest.

    A joint that starts, gives way, comes back and stops turns its acceleration round a few times, whatever
    the tick: more than 12 times are swinging, or more than 4 in successive ticks. Accelerations count that
    exceed a tenth of the joint's largest one and what takes it to its full speed in 20 s; the rest is noise.
    """
    rest = np.concatenate([q[:1], q, q[-1:]])
    acceleration = np.diff(rest, n=2, axis=0) / dt**2
    size = np.abs(acceleration)
    fastest = np.maximum(limits.speed_upper, -limits.speed_lower)
    fastest = np.where(np.isfinite(fastest), fastest, _FAST)
    band = np.maximum(_HARDLY * np.max(size, axis=0), _SLOWEST * fastest)
    side = np.where(size > band, np.sign(acceleration), 0.0)
    if np.any(_in_a_row(side[1:] * side[:-1] < 0.0, _MOST_IN_TURN + 1)):
        return True
    return any(np.count_nonzero(np.diff(column[column != 0.0])) > _MOST_TURNS for column in side.T)


def _in_a_row(found: NDArray[np.bool_], count: int) -> NDArray[np.bool_]:
    """Where so many rows of `found` (N, n), one after another, are True."""
    sums = np.cumsum(np.concatenate([np.zeros((1, found.shape[1])), found]), axis=0)
    return np.asarray(sums[count:] - sums[:-count] == count)
