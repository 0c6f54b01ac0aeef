"""Polynomials by their control points, and Gauss's rule for lengths."""

from __future__ import annotations

import numpy as np

from irlx.streams.joint_stream import Floats

GAUSS: tuple[Floats, Floats] = np.polynomial.legendre.leggauss(8)
"""Nodes in -1..1 and weights."""


def bernstein(u: Floats, degree: int) -> Floats:
    """Bernstein polynomials (R, degree + 1) of a degree at u (R,) in 0..1."""
    found = np.ones((len(u), 1))
    for _ in range(degree):
        wider = np.zeros((len(u), found.shape[1] + 1))
        wider[:, :-1] += found * (1.0 - u)[:, None]
        wider[:, 1:] += found * u[:, None]
        found = wider
    return found


def quintic_control(start: tuple[Floats, Floats, Floats], end: tuple[Floats, Floats, Floats]) -> Floats:
    """Control points (6, d) of the quintic over 0..1 by value and two derivatives (d,) at both ends."""
    (p0, rate, change), (p5, last_rate, last_change) = start, end
    p1, p4 = p0 + rate / 5.0, p5 - last_rate / 5.0
    p2, p3 = 2.0 * p1 - p0 + change / 20.0, 2.0 * p4 - p5 + last_change / 20.0
    return np.array([p0, p1, p2, p3, p4, p5])
