"""The numbers irlx promises, each in one place: producers aim below them, the verifier holds to them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

PATH_POSITION = 1e-6
"""Largest distance of the tool from the programmed pose of a tick, m."""

PATH_ORIENTATION = 1e-6
"""Largest angle between the tool's orientation and the programmed one of a tick, rad."""

LIMIT_EXCESS = 1e-9
"""Largest relative excess of a speed or acceleration bound, beside `rounding_allowance`."""

CLOSURE = 1e-6
"""Largest difference per joint between the postures at the ends of a closed cyclic path, rad or m."""


def rounding_allowance(q: NDArray[np.float64], dt: float) -> tuple[float, float]:
    """What float64 storage of joint values alone can add to differences of them.

    Backward differences of stored values q (any shape, rad or m) at tick `dt` (s) carry up to
    2 u/dt in speed and 4 u/dt^2 in acceleration, u = ulp(max |q|). Returns (speed, acceleration).
    """
    largest = float(np.max(np.abs(q))) if q.size else 0.0
    unit = float(np.spacing(largest))
    return 2.0 * unit / dt, 4.0 * unit / dt**2
