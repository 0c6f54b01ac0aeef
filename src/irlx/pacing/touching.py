"""Which bounds the rows of a planned motion touch.

A tick walk knows which bound held a joint; rows of a plan are read off by differences instead, with
the reserves a plan keeps.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.robot.limits import JointLimits
from irlx.transform.step_bounds import BoundSource

Array = NDArray[np.float64]

_POSITION = 2e-4
_SPEED = 1e-3
_ACCELERATION = 5e-3


def touching(start: Array, rows: Array, limits: JointLimits, dt: float) -> NDArray[np.int8]:
    """Flags (N, n) of rows (N, n) after rest at `start`, as in `MotionRows.active`.

    A joint touches a position limit within 2E-4 rad or m of it, a speed limit from 99.9 %, an acceleration
    limit from 99.5 % on; positions count before speeds, these before accelerations. Joints that rest
    touch nothing.
    """
    rest = np.vstack([start, start, rows])
    speeds = np.diff(rest, axis=0) / dt
    accelerations = np.diff(speeds, axis=0) / dt
    flags = np.zeros(rows.shape, dtype=np.int8)
    moving = np.any(rows != start, axis=0)
    for source, values, pair, share in (
        (BoundSource.ACCELERATION, accelerations, limits.pair("acceleration"), _ACCELERATION),
        (BoundSource.SPEED, speeds[1:], limits.pair("speed"), _SPEED),
    ):
        lower, upper = (bound * (1.0 - share) for bound in pair)
        flags[(values >= upper) & (values > 0.0)] = 1 + source
        flags[(values <= lower) & (values < 0.0)] = -(1 + source)
    position = 1 + BoundSource.POSITION
    flags[(rows >= limits.position_upper - _POSITION) & moving] = position
    flags[(rows <= limits.position_lower + _POSITION) & moving] = -position
    return flags
