"""A knot more near each end of a slowed motion, so that its ramps last as long as they must and no longer.

A clock accelerates evenly between two knots. Knots are as far apart as the tool goes in a few milliseconds at
the programmed speed; where joints allow a small part of that only, a ramp ends within the first interval, and
would be drawn out over all of it: 2 h / v s for h / v. So the clock gets a knot where the ramp may end.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.slowdown.clock import PlannedClock, plan_clock
from irlx.pacing.slowdown.clock_bounds import ClockBounds, clock_bounds
from irlx.pacing.slowdown.curve import JointCurve
from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]

LEAST_GAIN = 5e-4
"""Part of a motion's time below which a ramp stays as it is."""

_PLACES = np.exp2(-0.25 * np.arange(80))
"""Shares of an interval at which a ramp may end."""


def with_short_ends(
    clock: PlannedClock,
    curve: JointCurve,
    limits: JointLimits,
    rates: Array,
    rates_at: Callable[[Array], Array],
    acc: float | Array,
) -> PlannedClock:
    """The clock of a motion from rest to rest, its ramps shorter where that wins `LEAST_GAIN` of its time.

    Planned at the knots of `curve` from the programmed `rates` (N + 1,) there; `rates_at` gives those at path
    parameters (M,); `limits` and `acc` as in `clock_bounds`.
    """
    duration = clock.duration
    if not np.isfinite(duration):
        return clock
    least = LEAST_GAIN * duration
    if _most_gain(clock) <= least:
        return clock
    own = np.broadcast_to(acc, len(clock.s) - 1)
    places = [_ramp_end(clock, curve, limits, rates, rates_at, own, last) for last in (False, True)]
    gained = sum(gain for _, gain in places)
    if gained <= least:
        return clock
    inner = [place for place, gain in places if gain > 0.0]
    knots = np.union1d(clock.s, inner)
    programmed = rates_at(knots)
    programmed[np.searchsorted(knots, clock.s)] = rates
    within = np.searchsorted(clock.s, knots[:-1], side="right") - 1
    shorter = plan_clock(clock_bounds(curve, limits, programmed, own[within], knots))
    return clock if shorter is None or not shorter.duration < duration - least else shorter


def _most_gain(clock: PlannedClock) -> float:
    """Time (s) that the first and the last interval take beyond their way at full speed."""
    return float(
        sum(h / np.sqrt(x) for h, x in zip(np.diff(clock.s)[[0, -1]], clock.x[[1, -2]], strict=True))
    )


def _ramp_end(
    clock: PlannedClock,
    curve: JointCurve,
    limits: JointLimits,
    rates: Array,
    rates_at: Callable[[Array], Array],
    acc: Array,
    last: bool,
) -> tuple[float, float]:
    """Where the ramp of the first or `last` interval ends or begins, and the time (s) that this wins."""
    part = slice(-2, None) if last else slice(0, 2)
    s, x = clock.s[part], float(clock.x[part][0 if last else 1])
    width, rate = float(s[1] - s[0]), float(np.sqrt(x))
    steepest = _steepest(clock_bounds(curve, limits, rates[part], acc[-1:] if last else acc[:1], s), x, last)
    if not steepest > 0.0:
        return float(s[0]), 0.0
    ways = width * _PLACES
    places = s[1] - ways if last else s[0] + ways
    enough = (rates_at(places) >= rate) & (2.0 * steepest * ways >= x)
    way = float(np.min(ways[enough], initial=width))
    return float(s[1] - way if last else s[0] + way), (width - way) / rate


def _steepest(bounds: ClockBounds, x: float, last: bool) -> float:
    """Greatest d2s/dt2 from rest, or down to rest from the square rate x, in the one interval of bounds."""
    if last:
        return -float(np.max(bounds.bottom[0] + bounds.slope[0] * x))
    return float(np.min(bounds.top[0]))
