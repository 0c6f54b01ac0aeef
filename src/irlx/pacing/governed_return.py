"""Brings a posture back to a goal over a move, no faster than the joints can do it on the side.

A posture criterion must not pull at a goal far away: under acceleration limits it would overshoot and ring,
without them it would jump. What is pulled at is a reference of its own that starts where the posture is.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from irlx.motion.plan_joint_line import RAMP_TIME
from irlx.motion.time_law import TimeLaw
from irlx.pacing.return_way import ReturnWay
from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]

_SHARE = 0.5
_PEAK_RATE = 1.875
_PEAK_BEND = 10.0 / 3.0**0.5
"""Largest first and second derivative of the quintic 10 x^3 - 15 x^4 + 6 x^5."""


def governed_reference(way: ReturnWay, law: TimeLaw, limits: JointLimits) -> Callable[[float], Array]:
    """Reference posture over the path parameter of a move that follows `law`.

    r(s) = way.reference(c(s / length)) has the posture at the start as its best one and draws it `share` of
    the way along: c rises from 0 to share as the quintic share (10 x^3 - 15 x^4 + 6 x^5), at rest at both
    ends. The share is 1, or less where a joint would need more than half its speed or acceleration for the
    return alone; the next moves go on from there. Unknown accelerations count as speed / 0.2 s.
    """
    share = share_of_way(way, law, limits)

    def reference(s: float) -> Array:
        x = min(max(s / law.length, 0.0), 1.0)
        # At x = 1 the polynomial is exactly 1, so that a whole way ends at the goal's very values.
        return way.reference(share * x**3 * (10.0 - 15.0 * x + 6.0 * x**2))

    return reference


def share_of_way(way: ReturnWay, law: TimeLaw, limits: JointLimits) -> float:
    """Part of a way that fits into a move under half of each joint's limits.

    With postures q(p) and p(t) = share c(x(t)) the speed is q' p_t and the acceleration q'' p_t^2 + q' p_tt;
    |q'| and |q''| count with their largest values up to a knot, for every knot that the share may reach.
    """
    speed = np.minimum(limits.speed_upper, -limits.speed_lower)
    acc = np.minimum(limits.acceleration_upper, -limits.acceleration_lower)
    acc = np.where(np.isfinite(acc), acc, speed / RAMP_TIME)
    rate, growth = law.speed / law.length, law.acc / law.length
    fastest = _PEAK_RATE * rate
    # A trapezoid gains speed on its ramps alone, where the quintic is only as steep as at their inner ends;
    # other laws gain most of it up to there, and the half that is left free covers the rest.
    ramp = law.corners[1] / law.length
    hardest = _PEAK_BEND * rate**2 + 30.0 * ramp**2 * (1.0 - ramp) ** 2 * growth
    slope, bend = (_largest_so_far(way.postures(way.knots, order)) for order in (1, 2))
    even, square = slope * hardest, bend * fastest**2
    with np.errstate(divide="ignore", invalid="ignore"):
        # Root of square x^2 + even x = acc / 2, in the form that a straight way does not divide by zero.
        by_acc = 2.0 * _SHARE * acc / (even + np.sqrt(even**2 + 4.0 * _SHARE * acc * square))
        room = np.minimum(_SHARE * speed / (slope * fastest), np.where(np.isfinite(acc), by_acc, np.inf))
    fits = np.min(np.where(slope > 0.0, room, np.inf), axis=1)
    return float(np.max(np.minimum(fits, way.knots)))


def _largest_so_far(rows: Array) -> Array:
    return np.asarray(np.maximum.accumulate(np.abs(rows), axis=0))
