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

RESERVE = 1e-4
"""Distance (rad or m) that the curve keeps from position limits between its ends."""

_THINNED = 0.3
_PASSES = 16
_LEAD = 12
_OF_WIDTH = 0.25
_OF_WAY = 1e-3
_STILL = 1e-9
_FINER = (1.0, 0.25, 0.0625)
_LEAST_APART = 0.01


def even_curve(
    fibre: Fibre, iterates: Array, stride: float, widening: float = 1.0, all_at_once: bool = False
) -> Array:
    """Points (K, n) of the curve through iterates (M, n), M >= 2, evenly spaced by arc length.

    Iterates closer than 0.3 `stride` are passed over; a cubic spline through the others gives the points, a
    binomial mean over some 0.06 rad|m rounds the corners where a joint met its limit, and Newton steps within
    the limits lead each onto the pose. First and last are kept bit by bit. A spline through points that lie
    on a limit swings beyond it between them: inner points keep `RESERVE` away, `widening` times as much.
    Where a correction fails, the fibre bends too sharply: the same four and sixteen times finer, and at last
    the iterates themselves. `all_at_once`, for a dry run: points that nothing holds come onto the pose
    together.
    """
    for finer in _FINER:
        knots = _thinned(iterates, _THINNED * stride * finer)
        curve = _curve(fibre, iterates, knots, SPACING * finer, widening, all_at_once)
        if curve is not None:
            return curve
    return _thinned(iterates, _LEAST_APART * stride)


def _curve(
    fibre: Fibre, iterates: Array, knots: Array, spacing: float, widening: float, all_at_once: bool
) -> Array | None:
    """`even_curve` through knots (L, n) for one spacing; None where a point does not come onto the pose."""
    from scipy.interpolate import make_interp_spline

    way = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(knots, axis=0), axis=1))))
    pieces = max(LEAST_PIECES, ceil(way[-1] / spacing))
    due = np.linspace(0.0, way[-1], pieces + 1)
    spline = make_interp_spline(way, knots, k=3 if len(knots) >= 4 else 1)
    still = np.ptp(iterates, axis=0) <= _STILL
    reserve = widening * min(RESERVE, _OF_WAY * float(way[-1]))
    lower, upper = _kept(fibre, pieces + 1, reserve, still)
    points = _rounded(np.clip(spline(due), lower, upper))
    points[:, still] = knots[0, still]
    curve = [iterates[0]]
    together = fibre.all_onto_pose(points) if all_at_once else None
    for k in range(1, pieces):
        point, low, high = points[k], lower[k], upper[k]
        if together is not None and _serves(together[k], point, (low, high), 0.5 * spacing):
            curve.append(together[k])
            continue
        corrected = _onto_pose(fibre.within(low, high), point, 0.5 * spacing)
        if corrected is None:
            corrected = _onto_pose(fibre, point, 0.5 * spacing)
        if corrected is None:
            return None
        curve.append(corrected)
    return np.array([*curve, iterates[-1]])


def _serves(found: Array, point: Array, bounds: tuple[Array, Array], nearest: float) -> bool:
    """Whether a posture found for a point is one, within its bounds, and near it."""
    inside = (bounds[0] <= found) & (found <= bounds[1]) & (np.abs(found - point) <= nearest)
    return bool(np.all(inside))


def _onto_pose(fibre: Fibre, point: Array, nearest: float) -> Array | None:
    """The point led onto the pose; None where that leads further away than `nearest` (rad or m)."""
    found = fibre.onto_pose(point)
    return found if found is not None and float(np.max(np.abs(found - point))) <= nearest else None


def _kept(fibre: Fibre, points: int, reserve: float, still: NDArray[np.bool_]) -> tuple[Array, Array]:
    """Lower and upper positions (points, n): the limits less the reserve, which is nothing at both ends and
    full from the twelfth point on, for a narrow range at most a quarter of it, for joints that stand `still`
    (n,) nothing: the others may have no way that would move them."""
    index = np.arange(points)
    ramp = np.minimum(np.minimum(index, points - 1 - index) / _LEAD, 1.0)[:, None]
    kept = ramp * np.minimum(reserve, _OF_WIDTH * (fibre.upper - fibre.lower))
    kept[:, still] = 0.0
    return fibre.lower + kept, fibre.upper - kept


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
