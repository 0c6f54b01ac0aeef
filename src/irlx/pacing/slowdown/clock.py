"""The fastest clock on a curve: three sweeps over straight lines in (x, u), x = (ds/dt)^2, u = d2s/dt2.

The largest x at each knot for which some u exists comes with the bounds; a sweep backwards lowers it to
where every later bound can still be met by braking; a sweep forwards speeds up as fast as the lines allow.
Source of the idea: Bobrow, Dubowsky and Gibson, Time-optimal control of robotic manipulators along
specified paths, Int. J. Robotics Research 4 (3), 1985; the lines are those of `clock_bounds`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.slowdown.clock_bounds import PATH, ClockBounds, Governor, Joints

Array = NDArray[np.float64]

_ENTRY_SLACK = 1e-9


@dataclass(frozen=True)
class PlannedClock:
    """Squared rates `x` (N + 1,) at knots `s` (N + 1,), constant acceleration between them.

    `governor` and `joint` (N + 1,) tell what limits the rate at a knot, or at the narrower place behind
    it for which it brakes; joint -1 is the path itself.
    """

    s: Array
    x: Array
    governor: NDArray[np.int8]
    joint: Joints

    @property
    def times(self) -> Array:
        """Time (N + 1,) at which each knot is reached, s; infinite behind an interval that stands still."""
        rates = np.sqrt(self.x)
        with np.errstate(divide="ignore"):
            return np.concatenate([[0.0], np.cumsum(2.0 * np.diff(self.s) / (rates[:-1] + rates[1:]))])

    @property
    def duration(self) -> float:
        """Time from the first knot to the last, s."""
        return float(self.times[-1])

    def at(self, times: Array) -> tuple[Array, Array]:
        """s and ds/dt at times (M,) from the first knot on; s never falls."""
        knots = self.times
        i = np.clip(np.searchsorted(knots, times, side="right") - 1, 0, len(self.s) - 2)
        since = times - knots[i]
        u = 0.5 * np.diff(self.x)[i] / np.diff(self.s)[i]
        rate = np.sqrt(self.x[i])
        s = self.s[i] + rate * since + 0.5 * u * since**2
        return np.clip(s, self.s[i], self.s[i + 1]), np.maximum(rate + u * since, 0.0)


def plan_clock(
    bounds: ClockBounds, start_rate: float = 0.0, end_rate: float = 0.0, slack: float = _ENTRY_SLACK
) -> PlannedClock | None:
    """Fastest clock that keeps all bounds, entered and left at the given rates ds/dt.

    It may begin at any knot of a motion (see `ClockBounds.part`; `replan` between knots). None where
    the entry is too fast: its squared rate above what can still slow down by more than the share `slack`.
    """
    x, governor, joint = bounds.cap.copy(), bounds.governor.copy(), bounds.joint.copy()
    x[-1] = min(x[-1], end_rate**2)
    _backward(x, governor, joint, bounds)
    if start_rate**2 > x[0] * (1.0 + slack):
        return None
    x[0] = start_rate**2
    _forward(x, governor, joint, bounds)
    return PlannedClock(bounds.s, x, governor, joint)


def stopping_clock(
    bounds: ClockBounds, knot: int, rate: float, slack: float = _ENTRY_SLACK
) -> PlannedClock | None:
    """Clock that leaves `knot` at `rate` and comes to rest on the path at the first knot it can.

    None where the rate is too fast for a stop anywhere.
    """
    low, high = knot + 1, len(bounds.s) - 1
    best = plan_clock(bounds.part(knot, high), rate, slack=slack)
    while best is not None and low < high:
        middle = (low + high) // 2
        sooner = plan_clock(bounds.part(knot, middle), rate, slack=slack)
        if sooner is None:
            low = middle + 1
        else:
            best, high = sooner, middle
    return best


def _backward(x: Array, governor: NDArray[np.int8], joint: Joints, bounds: ClockBounds) -> None:
    """Lower x to where braking still meets everything behind it.

    The reason is the joint that cannot brake harder, else that of the place behind.
    """
    doubled = 2.0 * np.diff(bounds.s)[:, None]
    pull = 1.0 + doubled * bounds.slope
    # Lower lines: x_i (1 + 2h B) <= x_next - 2h bottom. Upper ones: x_next >= 0 must stay within reach.
    falls = pull > 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        per_next = np.where(falls, 1.0 / pull, 0.0)
        constant = np.where(falls, -doubled * bounds.bottom / pull, np.inf)
        still = np.where(falls, np.inf, doubled * bounds.top / np.abs(pull)).min(axis=1)
    constant = np.where(np.isnan(constant), np.inf, constant)
    for i in range(len(x) - 2, -1, -1):
        reaches = constant[i] + per_next[i] * x[i + 1]
        line = int(reaches.argmin())
        reach = min(float(reaches[line]), float(still[i]))
        if reach < x[i]:
            x[i] = max(reach, 0.0)
            behind = governor[i + 1], joint[i + 1]
            governor[i], joint[i] = _reason(bounds, line) or behind


def _forward(x: Array, governor: NDArray[np.int8], joint: Joints, bounds: ClockBounds) -> None:
    """Lower x to what speeding up from x[0] reaches; the reason is the joint that cannot do it faster."""
    doubled = 2.0 * np.diff(bounds.s)
    for i in range(len(x) - 1):
        tops = bounds.top[i] + bounds.slope[i] * x[i]
        line = int(tops.argmin())
        reach = max(x[i] + doubled[i] * float(tops[line]), 0.0)
        if reach < x[i + 1]:
            x[i + 1] = reach
            governor[i + 1], joint[i + 1] = _reason(bounds, line) or (governor[i], joint[i])


def _reason(bounds: ClockBounds, line: int) -> tuple[int, int] | None:
    """The joint whose acceleration a line stands for; None for the path's own."""
    of = int(bounds.line_joint[line])
    return None if of == PATH else (Governor.ACCELERATION, of)
