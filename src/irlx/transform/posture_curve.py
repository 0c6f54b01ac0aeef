"""From the iterates of a posture flow to an evenly spaced curve on the fibre, smooth enough for a spline."""

from __future__ import annotations

from math import ceil

import numpy as np
from numpy.typing import NDArray

from irlx.transform.fibre import Fibre

Array = NDArray[np.float64]

SPACING = 0.02
"""Distance between points of the curve, Euclidean, rad and m together; no joint moves more in one piece."""

LEAST_PIECES = 8
"""Pieces of the shortest curve: a spline wants some points."""

_THINNED = 0.3
_PASSES = 16


def even_curve(fibre: Fibre, iterates: Array, stride: float) -> Array:
    """Points (K, n) of the curve through iterates (M, n), M >= 2, evenly spaced by arc length.

    Iterates closer than 0.3 `stride` are passed over; a cubic spline through the others gives the points, a
    binomial mean over some 0.06 rad|m rounds the corners where a joint met its limit, and Newton steps within
    the limits lead each onto the pose. First and last are kept bit by bit. Where a correction fails, the
    iterates themselves are returned.
    """
    from scipy.interpolate import make_interp_spline

    knots = _thinned(iterates, _THINNED * stride)
    way = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(knots, axis=0), axis=1))))
    pieces = max(LEAST_PIECES, ceil(way[-1] / SPACING))
    due = np.linspace(0.0, way[-1], pieces + 1)
    spline = make_interp_spline(way, knots, k=3 if len(knots) >= 4 else 1)
    still = np.all(knots == knots[0], axis=0)
    points = _rounded(np.clip(spline(due), fibre.lower, fibre.upper))
    points[:, still] = knots[0, still]
    curve = [iterates[0]]
    for point in points[1:-1]:
        corrected = fibre.onto_pose(point)
        if corrected is None:
            return iterates
        curve.append(corrected)
    return np.array([*curve, iterates[-1]])


def _rounded(points: Array) -> Array:
    """Points after some passes of the mean 1/4, 1/2, 1/4; beyond an end goes on what lies before it, turned
    about it, so that ends and straight ways stay."""
    for _ in range(_PASSES):
        ahead = np.vstack([points[1:], 2.0 * points[-1] - points[-2]])
        behind = np.vstack([2.0 * points[0] - points[1], points[:-1]])
        points = 0.5 * points + 0.25 * (ahead + behind)
    return points


def _thinned(iterates: Array, least: float) -> Array:
    kept = [iterates[0]]
    for point in iterates[1:-1]:
        apart = min(float(np.linalg.norm(point - other)) for other in (kept[-1], iterates[-1]))
        if apart >= least:
            kept.append(point)
    return np.array([*kept, iterates[-1]])
