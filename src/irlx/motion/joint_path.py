"""Joint motion straight from posture to posture, and round the postures where they are blended."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class JointPath:
    """Postures over a parameter s, twice continuously differentiable, in P pieces.

    On a piece of width w, with x = s - its start and y = x / w, q = q0 + x a + (b - a) w (y^3 - y^4 / 2): the
    derivative goes from a to b as y^2 (3 - 2 y) does, every joint between its two values. A straight piece
    has a = b; in a blend they are those of the ways before and behind.

    `widths` (P,), `postures` (P, n) at the starts, `before` and `behind` (P, n) the derivatives a and b;
    `end` (n,) is the posture at the end.
    """

    widths: Array
    postures: Array
    before: Array
    behind: Array
    end: Array

    @cached_property
    def breaks(self) -> Array:
        """Values of s at which pieces meet (P + 1,), from 0."""
        return np.concatenate([[0.0], np.cumsum(self.widths)])

    @property
    def length(self) -> float:
        """Largest value of s."""
        return float(self.breaks[-1])

    def q(self, s: Array) -> Array:
        """Postures (N, n) at s (N,), the one at `length` exactly the end."""
        k, x, y = self._place(s)
        bent = (self.behind - self.before)[k] * (self.widths[k] * y**3 * (1.0 - 0.5 * y))[:, None]
        rows = self.postures[k] + x[:, None] * self.before[k] + bent
        rows[s >= self.length] = self.end
        return np.asarray(rows)

    def derivatives(self, s: Array) -> tuple[Array, Array]:
        """First and second derivative by s, each (N, n)."""
        k, _, y = self._place(s)
        change = (self.behind - self.before)[k]
        rate = self.before[k] + (y * y * (3.0 - 2.0 * y))[:, None] * change
        bend = (6.0 * y * (1.0 - y) / self.widths[k])[:, None] * change
        return np.asarray(rate), np.asarray(bend)

    def _place(self, s: Array) -> tuple[NDArray[np.intp], Array, Array]:
        """Piece of each s, the way on it, and its share of the piece."""
        k = np.clip(np.searchsorted(self.breaks, s, side="right") - 1, 0, len(self.widths) - 1)
        x = s - self.breaks[k]
        return k, x, x / self.widths[k]
