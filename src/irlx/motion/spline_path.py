"""Geometry of SPLINE: one smooth curve through the points of a PATH."""

from __future__ import annotations

from itertools import pairwise
from math import degrees, inf

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.diagnostics import Place, report
from irlx.motion.curved_path import CurvedPath
from irlx.motion.errors import MotionError
from irlx.motion.polynomial_curve import PolynomialCurve
from irlx.motion.turn import HALF_TURN_MARGIN
from irlx.motion.turn_curve import TurnCurve, TurnJet
from irlx.motion.whole_ticks import ticks_of_move

Array = NDArray[np.float64]

LONGEST_WAY = 1e9
"""Way, m, from which on a spline is beyond all numbers: no robot gets through it in the time of a move."""

SECTIONS = 12
"""Sections of a spline between two of its points, each with a speed of its own; more at sharp bends."""

_SLOWEST = 0.02
"""Least |dP/du|, u the chord length, of a spline that has a direction everywhere."""

_REFINEMENTS = 5
_STEADY = 1.5
_LEAST_TURN = 0.02

_STEEPEST = 1.5
"""A turn's rate at a point over the smaller one of both sides: beyond 2 a turn would swing past its end."""


def spline_path(positions: Array, rotations: Array, place: Place) -> tuple[CurvedPath, Array]:
    """Curve through K + 1 poses (positions (K + 1, 3) m, rotations (K + 1, 3, 3)), and s (K + 1,) of each.

    Position: the cubic spline over the length of the chords, curvature 0 at both ends: of all curves through
    the points the one that bends least. Orientation: see `_turns`. No two neighbours may coincide. Raises
    MotionError: IRL422 for half a turn between two points, IRL435 where the curve turns back on itself.
    """
    chords = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    knots = np.concatenate([[0.0], np.cumsum(chords)])
    if not knots[-1] < LONGEST_WAY:
        ticks_of_move(inf, 1.0, place)
    from scipy.interpolate import CubicSpline

    curve = PolynomialCurve(knots, CubicSpline(knots, positions, bc_type="natural").c)
    steps = np.linspace(0.0, 1.0, SECTIONS + 1)[:-1]
    cuts = np.append((knots[:-1, None] + chords[:, None] * steps).ravel(), knots[-1])
    speeds = _slowest(curve.velocities(cuts))
    if np.min(speeds) < _SLOWEST:
        point = round((int(np.argmin(speeds)) + 0.5) / SECTIONS)
        raise MotionError(report("IRL435", place, point=max(point, 1)))
    cuts = _refined(curve, cuts)
    at = curve.length_at(knots)
    at[-1] = curve.length
    turns = _turns(at, rotations, place)
    return CurvedPath(curve, turns, cuts, positions[-1], rotations[-1]), at


def _refined(curve: PolynomialCurve, cuts: Array) -> Array:
    """The cuts with more between where the curvature changes so fast that few samples would miss its peak."""
    for _ in range(_REFINEMENTS):
        ends = curve.along(cuts)[1], curve.along(0.5 * (cuts[:-1] + cuts[1:]))[1]
        at_cuts, between = (np.linalg.norm(bends, axis=1) for bends in ends)
        three = np.stack([at_cuts[:-1], between, at_cuts[1:]])
        # What turns the tangent by next to nothing may vary as it likes.
        turn = np.max(three, axis=0) * curve.speeds(0.5 * (cuts[:-1] + cuts[1:])) * np.diff(cuts)
        split = (np.max(three, axis=0) > _STEADY * np.min(three, axis=0)) & (turn > _LEAST_TURN)
        if not np.any(split):
            break
        cuts = np.sort(np.concatenate([cuts, 0.5 * (cuts[:-1] + cuts[1:])[split]]))
    return cuts


def _slowest(velocities: Array) -> Array:
    """Least length (N - 1,) on the straight ways between neighbours of N vectors (N, 3)."""
    first, change = velocities[:-1], np.diff(velocities, axis=0)
    square = np.sum(change * change, axis=1)
    share = np.divide(-np.sum(first * change, axis=1), square, out=np.zeros_like(square), where=square > 0.0)
    return np.asarray(np.linalg.norm(first + np.clip(share, 0.0, 1.0)[:, None] * change, axis=1))


def _turns(at: Array, rotations: Array, place: Place) -> TurnCurve:
    """Orientation over s: quintic in the rotation vector from point to point, no turn swings past its end.

    The rate at a point is the mean of both sides, each weighted with the length of the other, no larger than
    1.5 times the smaller; where the turn goes back it rests. Its change is 0 at all points.
    """
    turns = Rotation.from_matrix(np.transpose(rotations[:-1], (0, 2, 1)) @ rotations[1:]).as_rotvec()
    widest = float(np.max(np.linalg.norm(turns, axis=1)))
    if widest >= np.pi - HALF_TURN_MARGIN:
        raise MotionError(report("IRL422", place, angle=f"{degrees(widest):.6g}"))
    widths = np.diff(at)
    steady = np.einsum("kij,kj->ki", rotations[:-1], turns) / widths[:, None]
    inner = [
        _rate(a, b, behind / (before + behind))
        for a, b, before, behind in zip(steady[:-1], steady[1:], widths[:-1], widths[1:], strict=True)
    ]
    rates = [steady[0], *inner, steady[-1]]
    jets = [TurnJet(rotation, rate, np.zeros(3)) for rotation, rate in zip(rotations, rates, strict=True)]
    return TurnCurve.through(at, rotations[:-1], list(pairwise(jets)))


def _rate(before: Array, behind: Array, share: float) -> Array:
    if before @ behind <= 0.0:
        return np.zeros(3)
    mean = share * before + (1.0 - share) * behind
    most = _STEEPEST * min(np.linalg.norm(before), np.linalg.norm(behind))
    return np.asarray(mean * min(1.0, most / np.linalg.norm(mean)))
