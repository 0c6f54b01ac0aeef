"""Jerk-limited change of a rate without acceleration at either end, in closed form."""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt

import numpy as np

from irlx.motion.phases import Phases

_MOST_STEPS = 100
_NEAREST = 4.0 * 2.0**-52


def rising(first: float, last: float, acc: float, jerk: float) -> tuple[float, float]:
    """Time and way of the fastest change from the rate `first` up to `last`, at the mean rate of both."""
    gain = last - first
    span = 2.0 * sqrt(gain / jerk) if gain * jerk <= acc * acc else gain / acc + acc / jerk
    return span, 0.5 * (first + last) * span


def reach(first: float, way: float, acc: float, jerk: float) -> float:
    """Largest rate that can be reached from the rate `first` over a way."""
    if way == 0.0:
        return first
    return _kept(_reach(first, way, acc, jerk), first, lambda last: rising(first, last, acc, jerk)[1] <= way)


def _reach(first: float, way: float, acc: float, jerk: float) -> float:
    if rising(first, first + acc * acc / jerk, acc, jerk)[1] <= way:
        # (2 first + g) (g / acc + acc / jerk) = 2 way, g the gain.
        half = 0.5 * (2.0 * first + acc * acc / jerk)
        return first - half + sqrt(max(half * half - 2.0 * acc * (first * acc / jerk - way), 0.0))
    # With x = sqrt(g / jerk): jerk x^3 + 2 first x = way, convex; Newton falls from the right.
    x = float(np.cbrt(way / jerk))
    if first > 0.0:
        x = min(x, way / (2.0 * first))
    for _ in range(_MOST_STEPS):
        step = (jerk * x**3 + 2.0 * first * x - way) / (3.0 * jerk * x * x + 2.0 * first)
        x -= step
        if step <= _NEAREST * x:
            break
    return first + jerk * x * x


def add_s_curve(
    phases: Phases, first: float, last: float, way: float, speed: float, acc: float, jerk: float
) -> None:
    """Add the at most seven phases of the fastest motion over `way` between two rates.

    Neither rate is beyond `speed`, and each can be reached from the other on the way.
    """
    peak = _peak(first, last, way, speed, acc, jerk)
    up, down = rising(first, peak, acc, jerk)[1], rising(last, peak, acc, jerk)[1]
    _add_change(phases, first, peak, acc, jerk)
    flat = way - up - down
    if flat > 0.0:
        phases.add(flat / peak, flat, peak, acc, allowed_jerk=jerk)
    _add_change(phases, peak, last, acc, jerk)


def _peak(first: float, last: float, way: float, speed: float, acc: float, jerk: float) -> float:
    """Largest rate on the way."""

    def left(peak: float) -> float:
        return way - rising(first, peak, acc, jerk)[1] - rising(last, peak, acc, jerk)[1]

    least = max(first, last)
    if left(speed) >= 0.0:
        return speed
    if left(least) <= 0.0:
        return least
    from scipy.optimize import brentq

    found = float(brentq(left, least, speed, xtol=_NEAREST * speed, rtol=_NEAREST))
    return _kept(found, least, lambda peak: left(peak) >= 0.0)


def _kept(rate: float, least: float, fits: Callable[[float], bool]) -> float:
    """The rate, lowered by as little as lets it fit: rounding of a root must not lengthen the way."""
    step = _NEAREST * rate
    while rate > least and not fits(rate):
        rate, step = max(rate - step, least), 2.0 * step
    return rate


def _add_change(phases: Phases, first: float, last: float, acc: float, jerk: float) -> None:
    """Up to three phases that lead from one rate to another: jerk, constant acceleration, jerk back."""
    gain = abs(last - first)
    sign = 1.0 if last > first else -1.0
    bent = min(sqrt(gain / jerk), acc / jerk)
    top = jerk * bent
    steady = max(gain / acc - bent, 0.0) if gain * jerk > acc * acc else 0.0
    rates = [first, first + sign * 0.5 * top * bent, last - sign * 0.5 * top * bent, last]
    into = bent * (rates[0] + sign * top * bent / 6.0)
    even = 0.5 * steady * (rates[1] + rates[2])
    out = bent * (rates[3] - sign * top * bent / 6.0)
    phases.add(bent, into, rates[1], acc, 0.0, sign * jerk, jerk)
    phases.add(steady, even, rates[2], acc, sign * top, 0.0, jerk)
    phases.add(bent, out, rates[3], acc, sign * top, -sign * jerk, jerk)
