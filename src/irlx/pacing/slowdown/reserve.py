"""Distance that a planned motion keeps from position limits, so that a curve between knots stays inside."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]

RESERVE = 1e-4
"""Distance kept from a position limit, rad or m; of a narrow range no more than a quarter."""

_ROUNDING = 1e-12

LEAD = 12
"""Knots over which the reserve grows from nothing after the start, and shrinks before the end."""


def reserved(limits: JointLimits, knots: int, reserve: float) -> tuple[Array, Array]:
    """Lower and upper position bounds (knots, n) narrowed by the reserve, rad or m.

    A motion may start or end on a limit: within `LEAD` knots of either end the reserve is smaller, at
    the ends it is nothing.
    """
    index = np.arange(knots)
    ramp = np.minimum(np.minimum(index, knots - 1 - index) / LEAD, 1.0)[:, None]
    width = limits.position_upper - limits.position_lower
    kept = ramp * np.minimum(reserve, 0.25 * width)
    return limits.position_lower + kept, limits.position_upper - kept


def rounded_inside(q: Array, limits: JointLimits) -> Array:
    """Postures (..., n), those joints put on their limit that rounding left beyond it."""
    inside = limits.into_positions(q)
    return np.where(np.abs(inside - q) <= _ROUNDING, inside, q)
