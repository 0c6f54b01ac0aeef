"""Curves of polynomial pieces in space, run through by their arc length."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from scipy.interpolate import PPoly

Array = NDArray[np.float64]

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_NODES, _WEIGHTS = 0.5 * (_NODES + 1.0), 0.5 * _WEIGHTS

_PANELS = 8
_MOST_PANELS = 512
_SAME_LENGTH = 1e-14
_MOST_HALVINGS = 60
_MOST_STEPS = 50
_LAST_STEP = 1e-9

POINT = 1e-12
"""What is smaller, m, is a point: all but a stop where a curve turns in it, and not far from rounding."""


@dataclass(frozen=True)
class PolynomialCurve:
    """Curve P(u) of K pieces, `breaks` (K + 1,) of u, `coefficients` (d, K, 3) in m, highest power first.

    It never stands still, P'(u) != 0, so that its arc length s can take the place of u.
    """

    breaks: Array
    coefficients: Array

    @cached_property
    def length(self) -> float:
        """Arc length, m."""
        return float(self._table[1][-1])

    def length_at(self, u: Array) -> Array:
        """Arc length (N,) from the start to the parameters u (N,)."""
        knots, lengths = self._table
        k = np.clip(np.searchsorted(knots, u, side="right") - 1, 0, len(knots) - 2)
        return np.asarray(lengths[k] + self._way(knots[k], u))

    def parameters_at(self, s: Array) -> Array:
        """Parameters u (N,) at the arc lengths s (N,), to rounding."""
        knots, lengths = self._table
        s = np.clip(s, 0.0, lengths[-1])
        k = np.clip(np.searchsorted(lengths, s, side="right") - 1, 0, len(knots) - 2)
        first, last = knots[k], knots[k + 1]
        way = s - lengths[k]
        u = first + (last - first) * way / (lengths[k + 1] - lengths[k])
        for _ in range(_MOST_STEPS):
            step = (self._way(first, u) - way) / self.speeds(u)
            u = np.clip(u - step, first, last)
            # Newton squares the error: what is left is rounding.
            if np.all(np.abs(step) <= _LAST_STEP * (last - first)):
                break
        return np.asarray(u)

    def points(self, u: Array) -> Array:
        """Points (N, 3), m, at the parameters u (N,)."""
        return np.asarray(self._curve(u))

    def velocities(self, u: Array) -> Array:
        """dP/du (N, 3) at u (N,)."""
        return np.asarray(self._slope(u))

    def speeds(self, u: Array) -> Array:
        """ds/du (N,) at u (N,)."""
        return np.asarray(np.linalg.norm(self._slope(u), axis=-1))

    def along(self, u: Array) -> tuple[Array, Array]:
        """First and second derivative by the arc length, each (N, 3), at the parameters u (N,)."""
        slope, bend = self._slope(u), self._bend(u)
        speed = np.linalg.norm(slope, axis=-1, keepdims=True)
        tangent = slope / speed
        across = bend - np.sum(bend * tangent, axis=-1, keepdims=True) * tangent
        return np.asarray(tangent), np.asarray(across / speed**2)

    def curvature(self, u: Array) -> Array:
        """Curvature (N,), 1/m, at the parameters u (N,); at most that of a circle as small as `POINT`."""
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            return np.asarray(np.fmin(np.linalg.norm(self.along(u)[1], axis=1), 1.0 / POINT))

    @cached_property
    def _table(self) -> tuple[Array, Array]:
        """Knots of u and the arc length at each, close enough for Gauss's rule to be exact to rounding."""
        panels = _PANELS
        table = self._lengths(panels)
        while panels < _MOST_PANELS:
            finer = self._lengths(2 * panels)
            if abs(finer[1][-1] - table[1][-1]) <= _SAME_LENGTH * finer[1][-1]:
                return table
            panels, table = 2 * panels, finer
        return self._halved(table[0])

    def _halved(self, knots: Array) -> tuple[Array, Array]:
        """The table of knots with more between them beside bends so narrow that even panels do not do."""
        for _ in range(_MOST_HALVINGS):
            middles = 0.5 * (knots[:-1] + knots[1:])
            whole, first = self._way(knots[:-1], knots[1:]), self._way(knots[:-1], middles)
            halves = first + self._way(middles, knots[1:])
            off = np.abs(halves - whole) > 0.1 * _SAME_LENGTH * np.sum(halves)
            if not np.any(off):
                break
            knots = np.sort(np.concatenate([knots, middles[off]]))
        return self._table_of(knots)

    def _lengths(self, panels: int) -> tuple[Array, Array]:
        steps = np.linspace(0.0, 1.0, panels + 1)[:-1]
        knots = (self.breaks[:-1, None] + np.diff(self.breaks)[:, None] * steps).ravel()
        return self._table_of(np.append(knots, self.breaks[-1]))

    def _table_of(self, knots: Array) -> tuple[Array, Array]:
        return knots, np.concatenate([[0.0], np.cumsum(self._way(knots[:-1], knots[1:]))])

    def _way(self, first: Array, last: Array) -> Array:
        """Arc length (N,) between parameters (N,) of one piece, by Gauss and Legendre."""
        width = last - first
        u = first[:, None] + width[:, None] * _NODES
        return np.asarray(width * (self.speeds(u.ravel()).reshape(u.shape) @ _WEIGHTS))

    @cached_property
    def _curve(self) -> PPoly:
        from scipy.interpolate import PPoly

        return PPoly(self.coefficients, self.breaks)

    @cached_property
    def _slope(self) -> PPoly:
        return self._curve.derivative(1)

    @cached_property
    def _bend(self) -> PPoly:
        return self._curve.derivative(2)
