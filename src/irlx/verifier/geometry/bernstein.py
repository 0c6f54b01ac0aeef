"""Polynomial curves by their control points: values, nearest points, and Gauss's rule for lengths."""

from __future__ import annotations

from collections.abc import Callable
from math import comb

import numpy as np

from irlx.streams.joint_stream import Floats

GAUSS: tuple[Floats, Floats] = np.polynomial.legendre.leggauss(8)
"""Nodes in -1..1 and weights."""


_BINOMIALS = [np.array([comb(degree, k) for k in range(degree + 1)], dtype=np.float64) for degree in range(6)]


def bernstein(u: Floats, degree: int) -> Floats:
    """Bernstein polynomials (R, degree + 1) of a degree at u (R,) in 0..1."""
    powers = np.arange(degree + 1)
    return np.asarray(_BINOMIALS[degree] * u[:, None] ** powers * (1.0 - u)[:, None] ** powers[::-1])


def quintic_control(start: tuple[Floats, Floats, Floats], end: tuple[Floats, Floats, Floats]) -> Floats:
    """Control points (6, d) of the quintic over 0..1 by value and two derivatives (d,) at both ends."""
    (p0, rate, change), (p5, last_rate, last_change) = start, end
    p1, p4 = p0 + rate / 5.0, p5 - last_rate / 5.0
    p2, p3 = 2.0 * p1 - p0 + change / 20.0, 2.0 * p4 - p5 + last_change / 20.0
    return np.array([p0, p1, p2, p3, p4, p5])


Jets = tuple[Floats, Floats, Floats]
"""Positions and two derivatives by the parameter, each (R, 3)."""

MOST_STEPS, LAST_STEP = 40, 1e-13
"""Steps of the search for nearest points, and the step by the parameter after which it ends."""


def nearest_parameters(
    jet: Callable[[Floats], Jets], positions: Floats, seeds: Floats, cell: float | Floats, most: float
) -> Floats:
    """Parameters (R,) in 0..`most` of the points nearest to positions (R, 3), within a `cell` of their seeds.

    Newton's method on the way along the curve that is left; a step that leaves the bracket halves it instead.
    """
    low, high = np.maximum(seeds - cell, 0.0), np.minimum(seeds + cell, most)
    u = seeds
    for _ in range(MOST_STEPS):
        points, rates, changes = jet(u)
        off = positions - points
        ahead = np.sum(off * rates, axis=1)
        slope = np.sum(off * changes - rates * rates, axis=1)
        low, high = np.where(ahead > 0.0, u, low), np.where(ahead > 0.0, high, u)
        found = u - ahead / np.where(slope < 0.0, slope, -1.0)
        inside = (slope < 0.0) & (found >= low) & (found <= high)
        found = np.where(inside, found, 0.5 * (low + high))
        step, u = np.abs(found - u), found
        if not (step > LAST_STEP).any():
            break
    return np.asarray(u)
