"""The fastest clock whose acceleration changes no faster than the programme allows, on a curve q(s).

Of a clock on fixed knots the jerk d3s/dt3 is (u_next - u) / t, u the acceleration d2s/dt2 of an interval and
t the time from the middle of one to that of the next. No clock within the bounds is faster anywhere than the
fastest one without a bound on jerk, whose times are known. Kept with these times the bound is linear in x =
(ds/dt)^2, and so it is kept with the clock's own, which are longer. What is left is a linear program.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from irlx.motion.time_law import TimeLaw
from irlx.pacing.slowdown.clock import PlannedClock, plan_clock
from irlx.pacing.slowdown.clock_bounds import ClockBounds, clock_bounds
from irlx.pacing.slowdown.curve import JointCurve
from irlx.pacing.slowdown.grid import acc_between
from irlx.robot.limits import JointLimits

if TYPE_CHECKING:
    from scipy.sparse import csr_matrix

Array = NDArray[np.float64]

MOST_KNOTS = 60_000
"""A clock of more knots would take long to plan; those of longer motions are farther apart than asked for."""

_RESERVE = 0.03
"""Part of the jerk that is left unused, for what happens between knots."""
_AS_PROGRAMMED = 1e-9


@dataclass(frozen=True)
class SmoothRate:
    """What a clock that bounds its jerk is planned from: the programmed law, `acc`, the largest |d2s/dt2| of
    the motion, and `step`, the time (s) from knot to knot."""

    law: TimeLaw
    acc: float
    step: float

    @property
    def bounds_jerk(self) -> bool:
        """Whether the law bounds it anywhere."""
        return bool(np.any(np.isfinite(self.law.jerk_at(np.array(self.law.corners)))))

    def clock(self, curve: JointCurve, limits: JointLimits) -> PlannedClock | None:
        """The fastest clock from rest to rest; None where the motion stands somewhere whatever the clock."""
        times = self.law.times_at(curve.s)
        knots = _with_more(curve.s, self.law.evaluate(_between(times, self._step(times[-1])))[0])
        rough = self._fastest(curve, limits, knots)[1]
        if rough is None or not np.isfinite(rough.duration):
            return None
        # What is slower than programmed needs more knots for the same times.
        knots = _with_more(knots, rough.at(_between(rough.times, self._step(rough.duration)))[0])
        bounds, fastest = self._fastest(curve, limits, knots)
        if fastest is None or not np.isfinite(fastest.duration):
            return None
        programmed = self.law.rates_at(knots) ** 2
        if np.all(fastest.x >= programmed * (1.0 - _AS_PROGRAMMED)):
            return fastest
        x = _smooth(bounds, fastest, programmed, self.law.jerk_at(knots))
        x = _scaled_down(bounds, fastest, programmed) if x is None else x
        return None if x is None else PlannedClock(knots, x, fastest.governor, fastest.joint)

    def _step(self, duration: float) -> float:
        return max(self.step, duration / MOST_KNOTS)

    def _fastest(
        self, curve: JointCurve, limits: JointLimits, knots: Array
    ) -> tuple[ClockBounds, PlannedClock | None]:
        acc = np.minimum(self.acc, acc_between(self.law, knots))
        bounds = clock_bounds(curve, limits, self.law.rates_at(knots), acc, knots)
        return bounds, plan_clock(bounds)


def _between(times: Array, step: float) -> Array:
    """Times (M,) that leave no two neighbours of rising `times` (N + 1,) more than `step` apart."""
    parts = np.ceil(np.diff(times) / step - 1e-6).astype(int)
    found = [np.linspace(times[k], times[k + 1], parts[k] + 1)[1:-1] for k in np.flatnonzero(parts > 1)]
    return np.concatenate([np.empty(0), *found])


def _with_more(knots: Array, more: Array) -> Array:
    """The knots and more of them, none where there is one but for rounding."""
    together = np.union1d(knots, more)
    apart = np.diff(together) > 1e-13 * together[-1]
    kept = together[np.append(True, apart)]
    kept[-1] = knots[-1]
    return np.asarray(kept)


def _smooth(bounds: ClockBounds, fastest: PlannedClock, programmed: Array, jerk: Array) -> Array | None:
    """x (N + 1,) of the fastest clock within the jerk (N + 1,) allowed at the knots; None if none is found.

    Where the programme itself, in intervals of constant acceleration, goes beyond, so may the clock.
    """
    from scipy.optimize import linprog
    from scipy.sparse import diags, vstack

    # In shares of the fastest clock's x, which are all of the same size.
    rise = _rises(bounds.s, fastest.x)
    change = rise[1:] - rise[:-1]
    steps = np.diff(fastest.times)
    as_programmed = np.diff(programmed) / (2.0 * np.diff(bounds.s))
    most = (1.0 - _RESERVE) * jerk[1:-1] * 0.5 * (steps[:-1] + steps[1:])
    most = np.maximum(most, np.abs(np.diff(as_programmed)))
    ends = np.maximum((1.0 - _RESERVE) * jerk[[0, -1]] * steps[[0, -1]], np.abs(as_programmed[[0, -1]]))
    bounded = np.isfinite(most)
    rows = [change[bounded], -change[bounded], rise[:1], -rise[-1:]]
    rights = [most[bounded], most[bounded], ends[:1], ends[1:]]
    for side, sign in ((bounds.top, 1.0), (-bounds.bottom, -1.0)):
        lines, room = _lines(rise, side, sign, bounds.slope, fastest.x)
        rows.append(lines)
        rights.append(room)
    matrix, right = vstack(rows).tocsr(), np.concatenate(rights)
    finite = np.isfinite(right)
    matrix, right = matrix[finite], right[finite]
    scale = 1.0 / np.maximum(abs(matrix).max(axis=1).toarray().ravel(), 1e-300)
    # The time of the clock falls with x as these weights tell, near the fastest one.
    weights = np.append(steps, 0.0) + np.append(0.0, steps)
    upper = np.ones(len(weights))
    upper[[0, -1]] = 0.0
    limits = np.column_stack([np.zeros_like(upper), upper])
    found = linprog(-weights, diags(scale) @ matrix, right * scale, bounds=limits, method="highs-ds")
    if found.status != 0 or np.any(found.x[1:-1] <= 0.0):
        return None
    x = np.clip(found.x, 0.0, 1.0) * fastest.x
    x[[0, -1]] = 0.0
    return np.asarray(x)


def _rises(s: Array, x: Array) -> csr_matrix:
    """Matrix (N, N + 1): d2s/dt2 in the intervals between knots s (N + 1,) of shares of x (N + 1,)."""
    from scipy.sparse import csr_matrix

    doubled, interval = 2.0 * np.diff(s), np.arange(len(s) - 1)
    values = np.concatenate([-x[:-1] / doubled, x[1:] / doubled])
    places = np.tile(interval, 2), np.concatenate([interval, interval + 1])
    return csr_matrix((values, places), shape=(len(s) - 1, len(s)))


def _lines(rise: csr_matrix, side: Array, sign: float, slope: Array, x: Array) -> tuple[csr_matrix, Array]:
    """Rows of  sign (u - slope x_i) <= side  for the lines (N, K) that can matter below x (N + 1,)."""
    from scipy.sparse import csr_matrix

    at_rest, at_most = side, side + sign * slope * x[:-1, None]
    count = side.shape[1]
    matters = np.isfinite(side)
    for k in range(count):
        # Beyond another one at both ends it is so in between; of two that are the same the first one counts.
        later = np.arange(count) < k
        rest, most = at_rest[:, k : k + 1], at_most[:, k : k + 1]
        beyond = (rest >= at_rest) & (most >= at_most)
        same = (rest == at_rest) & (most == at_most)
        matters[:, k] &= ~np.any(beyond & (~same | later), axis=1)
    interval, line = np.nonzero(matters)
    own = sign * slope[interval, line] * x[interval]
    slopes = csr_matrix((own, (np.arange(len(own)), interval)), shape=(len(own), len(x)))
    return sign * rise[interval] - slopes, side[interval, line]


def _scaled_down(bounds: ClockBounds, fastest: PlannedClock, programmed: Array) -> Array | None:
    """x (N + 1,) of the programme, its shape kept, in a time in which it keeps all bounds; None for none."""
    inner = programmed > 0.0
    share = float(np.min(fastest.x[inner] / programmed[inner], initial=1.0))
    u = (np.diff(programmed) / (2.0 * np.diff(bounds.s)))[:, None] - bounds.slope * programmed[:-1, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        rooms = np.where(u > 0.0, bounds.top / u, np.where(u < 0.0, bounds.bottom / u, np.inf))
    share = min(share, float(np.nanmin(rooms)))
    return share * programmed if share > 0.0 else None
