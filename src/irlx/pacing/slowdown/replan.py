"""The clock of a motion that is under way, planned anew from where it is, or to rest on the path."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.motion.time_law import TimeLaw
from irlx.pacing.slowdown.clock import PlannedClock, plan_clock, stopping_clock
from irlx.pacing.slowdown.clock_bounds import ClockBounds, Reserves, clock_bounds
from irlx.pacing.slowdown.curve import JointCurve
from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]

_SHORTEST = 0.1
_SLACK = 2e-5
_RESERVES = Reserves(0.0, 2e-4)
"""Less than a first clock keeps: the points at which accelerations are looked at are other ones now, and what
was just allowed must still be."""


def replan(
    curve: JointCurve, limits: JointLimits, law: TimeLaw, acc: float, s: float, rate: float
) -> PlannedClock | None:
    """Fastest clock from the path parameter `s`, run through at `rate` (per s) now, to the end of the curve.

    The limits and the law may be other than those planned with before: a new override, a new limit. From a
    rate above the law's the clock brakes with `acc` until it meets the law. None where the rate is too
    high for them.
    """
    return plan_clock(_rest(curve, limits, law, acc, s, rate), rate, slack=_SLACK)


def brake(
    curve: JointCurve, limits: JointLimits, law: TimeLaw, acc: float, s: float, rate: float
) -> PlannedClock | None:
    """Clock from `s`, run through at `rate`, to rest at the first knot of the curve that allows it.

    On a clock planned by `plan_clock` there is always one: the end of the motion at the latest.
    """
    return stopping_clock(_rest(curve, limits, law, acc, s, rate), 0, rate, slack=_SLACK)


def _rest(
    curve: JointCurve, limits: JointLimits, law: TimeLaw, acc: float, s: float, rate: float
) -> ClockBounds:
    """Bounds on what is left of a curve behind `s`, run through at `rate`."""
    i = min(int(np.searchsorted(curve.s, s, side="right")) - 1, len(curve.s) - 2)
    ahead = curve.s[curve.s > s + _SHORTEST * (curve.s[i + 1] - curve.s[i])]
    knots = np.concatenate([[s], ahead if ahead.size else curve.s[-1:]])
    braking = np.sqrt(np.maximum(rate**2 - 2.0 * acc * (knots - s), 0.0))
    return clock_bounds(curve, limits, np.maximum(law.rates_at(knots), braking), acc, knots, _RESERVES)
