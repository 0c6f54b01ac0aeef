"""Postures over the path parameter, as a smooth curve."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

Array = NDArray[np.float64]


@dataclass(frozen=True)
class JointCurve:
    """Cubic spline q(s) through postures q (N + 1, n) at knots s (N + 1,), twice continuously differentiable.

    Joints that are the same at all knots stay bit-identical. s in the path's unit, q in rad or m.
    """

    s: Array
    q: Array

    @cached_property
    def _spline(self) -> CubicSpline:
        from scipy.interpolate import CubicSpline

        return CubicSpline(self.s, self.q, bc_type="not-a-knot")

    def at(self, s: Array) -> Array:
        """Postures at parameters s (M,), shape (M, n)."""
        found = np.asarray(self._spline(s))
        still = np.all(self.q == self.q[0], axis=0)
        found[:, still] = self.q[0, still]
        return found

    def derivatives(self, s: Array) -> tuple[Array, Array]:
        """First and second derivative by s at parameters s (M,), each (M, n)."""
        return np.asarray(self._spline(s, 1)), np.asarray(self._spline(s, 2))
