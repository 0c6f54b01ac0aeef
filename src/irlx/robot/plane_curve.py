"""A smooth curve in the plane through given points, and the point of it that is nearest to another one."""

from __future__ import annotations

from bisect import bisect_right
from functools import cached_property
from math import hypot, inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SPACING = 0.01
"""Greatest distance of the samples, m, among which the nearest point is sought first."""

_LEAST_SAMPLES = 16
_MOST_STEPS = 50
_FLAT = 1e-12
_SHORT = 1e-9
_ROUNDING = 1e-14


class CurvePoint(NamedTuple):
    """The point of a curve nearest to a point of the plane, m.

    `offset`: signed distance of the point from the curve, positive on the left of the unit tangent
    (`tx`, `ty`); `curvature`, 1/m, positive where the curve bends to the left.
    """

    x: float
    y: float
    tx: float
    ty: float
    curvature: float
    offset: float


class PlaneCurve:
    """A cubic spline by the length of its chords, with continuous curvature.

    An open one has curvature 0 at both ends, where it goes on straight; two points are a straight line. A
    closed one leads from the last point on to the first. No two neighbours of `points` (K, 2) m may be the
    same.
    """

    def __init__(self, points: Array, closed: bool = False) -> None:
        ends = np.vstack([points, points[:1]]) if closed else np.asarray(points, dtype=np.float64)
        chords = np.hypot(*np.diff(ends, axis=0).T)
        bends = _closed_bends(ends, chords) if closed else _open_bends(ends, chords)
        slope = np.diff(ends, axis=0) / chords[:, None]
        first = slope - chords[:, None] * (2.0 * bends[:-1] + bends[1:]) / 6.0
        third = np.diff(bends, axis=0) / (6.0 * chords[:, None])
        # Of each piece the polynomial of the length t on its chord: 1, t, t^2, t^3 by x, y.
        self._pieces = np.stack([ends[:-1], first, 0.5 * bends[:-1], third], axis=1)
        self._tables: list[list[list[float]]] = self._pieces.tolist()
        self._knots = np.concatenate([[0.0], np.cumsum(chords)])
        self._begins: list[float] = self._knots.tolist()
        self._closed = closed
        count = np.maximum(_LEAST_SAMPLES, np.ceil(1.2 * chords / SPACING)).astype(int)
        parts = [
            np.linspace(a, b, n, endpoint=False)
            for a, b, n in zip(self._knots[:-1], self._knots[1:], count, strict=True)
        ]
        self.parameters = np.concatenate([*parts, self._knots[-1:]])
        self.samples = self._values(self.parameters, 0)
        self._half_squares = 0.5 * np.sum(self.samples**2, axis=1)
        self._rounding = _ROUNDING * float(self._knots[-1] + np.max(np.abs(self.samples)))

    @cached_property
    def ends(self) -> tuple[CurvePoint, CurvePoint]:
        """Its first and its last point."""
        return self._at(0.0, None), self._at(self._begins[-1], None)

    @cached_property
    def _straight(self) -> tuple[tuple[CurvePoint, float], ...]:
        """The open ends, and on which side of them the curve goes on straight."""
        return () if self._closed else ((self.ends[0], -1.0), (self.ends[1], 1.0))

    @cached_property
    def is_straight(self) -> bool:
        """Whether it is a straight line."""
        return not self._closed and float(np.max(np.abs(self.curvatures()))) < _FLAT

    def curvatures(self) -> Array:
        """Curvature, 1/m, at the `parameters` (N,); infinite where the curve stands still or turns back."""
        (rx, ry), (cx, cy) = self._values(self.parameters, 1).T, self._values(self.parameters, 2).T
        speed = np.hypot(rx, ry)
        still = speed < 1e-9
        return np.asarray(np.where(still, inf, (rx * cy - ry * cx) / np.where(still, 1.0, speed) ** 3))

    def nearest(self, x: float, y: float) -> CurvePoint:
        """The nearest point of the curve and of its straight ends to (x, y).

        Sought among samples of the whole curve, then by Newton's method: the same for a point wherever the
        one before it was.
        """
        # |s - p|^2 without what is the same for all samples s.
        index = int(np.argmin(self._half_squares - self.samples @ np.array([x, y])))
        found = self._at(self._refined(index, x, y), (x, y))
        for beyond in self._beyond(x, y):
            if abs(beyond.offset) < hypot(x - found.x, y - found.y):
                found = beyond
        return found

    def _refined(self, index: int, x: float, y: float) -> float:
        """Parameter of the nearest point about a sample: Newton's method, kept within the neighbours."""
        at = self.parameters
        low, high = float(at[max(index - 1, 0)]), float(at[min(index + 1, len(at) - 1)])
        u, length = float(at[index]), self._begins[-1]
        if self._closed and index in (0, len(at) - 1):
            low, high = float(at[-2]) - length, float(at[1])
            u = 0.0
        for _ in range(_MOST_STEPS):
            px, py, rx, ry, cx, cy = self._jet(u % length if self._closed else u)
            ahead = (x - px) * rx + (y - py) * ry
            rate = rx * rx + ry * ry - (x - px) * cx - (y - py) * cy
            low, high = (u, high) if ahead > 0.0 else (low, u)
            step = ahead / rate if rate > 0.0 else inf
            new = u + step
            newton = low <= new <= high
            if not newton:
                new = 0.5 * (low + high)
            moved, u = abs(new - u), new
            # A short step of Newton's method leaves its square.
            if moved <= (_SHORT if newton else self._rounding):
                break
        return u % length if self._closed else u

    def _at(self, u: float, of: tuple[float, float] | None) -> CurvePoint:
        px, py, rx, ry, cx, cy = self._jet(u)
        speed = hypot(rx, ry) or 1e-300
        tx, ty = rx / speed, ry / speed
        offset = 0.0 if of is None else tx * (of[1] - py) - ty * (of[0] - px)
        return CurvePoint(px, py, tx, ty, (rx * cy - ry * cx) / speed**3, offset)

    def _beyond(self, x: float, y: float) -> list[CurvePoint]:
        """Feet of (x, y) on the straight ends, where it has any."""
        found = []
        for end, side in self._straight:
            ahead = end.tx * (x - end.x) + end.ty * (y - end.y)
            if side * ahead > 0.0:
                offset = end.tx * (y - end.y) - end.ty * (x - end.x)
                foot = end.x + ahead * end.tx, end.y + ahead * end.ty
                found.append(CurvePoint(*foot, end.tx, end.ty, 0.0, offset))
        return found

    def _jet(self, u: float) -> tuple[float, float, float, float, float, float]:
        """Position, and first and second derivative by u, in x, y, x, y, x, y."""
        piece = min(max(bisect_right(self._begins, u) - 1, 0), len(self._tables) - 1)
        t = u - self._begins[piece]
        (ax, ay), (bx, by), (cx, cy), (dx, dy) = self._tables[piece]
        return (
            ax + t * (bx + t * (cx + t * dx)),
            ay + t * (by + t * (cy + t * dy)),
            bx + t * (2.0 * cx + 3.0 * t * dx),
            by + t * (2.0 * cy + 3.0 * t * dy),
            2.0 * cx + 6.0 * t * dx,
            2.0 * cy + 6.0 * t * dy,
        )

    def _values(self, u: Array, order: int) -> Array:
        """The curve's derivative of an order from 0 to 2 at parameters u (N,), shape (N, 2)."""
        piece = np.clip(np.searchsorted(self._knots, u, side="right") - 1, 0, len(self._pieces) - 1)
        t = (u - self._knots[piece])[:, None]
        a, b, c, d = np.moveaxis(self._pieces[piece], 1, 0)
        if order == 0:
            return np.asarray(a + t * (b + t * (c + t * d)))
        return np.asarray(b + t * (2.0 * c + 3.0 * t * d) if order == 1 else 2.0 * c + 6.0 * t * d)


def _open_bends(points: Array, chords: Array) -> Array:
    """Second derivatives (K, 2) of the spline through K points, 0 at both ends."""
    bends, inner = np.zeros_like(points), len(points) - 2
    if inner:
        matrix = np.diag(2.0 * (chords[:-1] + chords[1:]))
        rows = np.arange(inner - 1)
        matrix[rows, rows + 1] = matrix[rows + 1, rows] = chords[1:-1]
        bends[1:-1] = np.linalg.solve(
            matrix, 6.0 * np.diff(np.diff(points, axis=0) / chords[:, None], axis=0)
        )
    return bends


def _closed_bends(points: Array, chords: Array) -> Array:
    """The same for a curve whose last point is its first: the derivatives there are the same."""
    count = len(chords)
    before, here = np.roll(chords, 1), np.arange(count)
    matrix = np.diag(2.0 * (before + chords))
    np.add.at(matrix, (here, (here - 1) % count), before)
    np.add.at(matrix, (here, (here + 1) % count), chords)
    slopes = np.diff(points, axis=0) / chords[:, None]
    bends = np.linalg.solve(matrix, 6.0 * (slopes - np.roll(slopes, 1, axis=0)))
    return np.vstack([bends, bends[:1]])
