"""How far the joints are from the middle of their ranges."""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np

from irlx.robot.limits import JointLimits
from irlx.transform.measures.measure import Array, Measure

Form = Literal["square", "barrier"]

STEEPEST = 1e6
"""Largest slope of a joint's barrier per half of its range: met at 0.07 % of that half before the limit."""


class JointCentring(Measure):
    """Mean over the joints of a function of x = (q - middle) / (half range), which is +-1 on the limits.

    "square": x^2 (Liegeois 1977), finite also beyond the limits. "barrier": 1 / (1 - x^2), that is
    range^2 / (4 (upper - q) (q - lower)) (Zghal, Dubey and Euler 1990), infinite on the limits and
    beyond. Its slope 2 x / (half range (1 - x^2)^2) is held at +-`STEEPEST` / half range there and
    closely before, so that a descent leads inwards at every posture. Joints without two finite limits,
    or whose limits leave them no range, take no part: the mean is over the others, their own slope is 0.
    Where no joint takes part the measure is 0.
    """

    name = "joint centring"
    sense = 1

    def __init__(self, limits: JointLimits, form: Form = "square") -> None:
        """Measure within the position limits; raises ValueError where the form is unknown."""
        if form not in get_args(Form):
            raise ValueError(f"joint centring has the forms {', '.join(get_args(Form))}, not '{form}'")
        self.form = form
        lower, upper = limits.position_lower, limits.position_upper
        self._part = np.isfinite(lower) & np.isfinite(upper) & (upper > lower)
        self._lower, self._upper = lower[self._part], upper[self._part]
        self._half = 0.5 * self._upper - 0.5 * self._lower

    def _from_middle(self, q: Array) -> tuple[Array, Array]:
        """x and 1 - x^2 of the joints that take part, the latter to full precision next to a limit."""
        q = q[self._part]
        below, above = (q - self._lower) / self._half, (self._upper - q) / self._half
        return 0.5 * (below - above), below * above

    def value(self, q: Array) -> float:
        """Mean of x^2 or of 1 / (1 - x^2); inf for the barrier where a joint is at a limit or beyond."""
        x, room = self._from_middle(q)
        if not x.size:
            return 0.0
        if self.form == "square":
            return float(x @ x) / x.size
        return float(np.mean(1.0 / room)) if room.min() > 0.0 else np.inf

    def gradient(self, q: Array) -> Array:
        """Derivative by q, shape (n,), per rad or m; for the barrier held at its cap near the limits."""
        x, room = self._from_middle(q)
        if self.form == "square":
            slope = 2.0 * x
        else:
            # Below this room the slope is capped in any case; beyond a limit the room is negative.
            slope = np.clip(2.0 * x / np.maximum(room, 1e-6) ** 2, -STEEPEST, STEEPEST)
        result = np.zeros(q.size)
        result[self._part] = slope / (self._half * max(x.size, 1))
        return result
