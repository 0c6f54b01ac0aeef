"""The curve that leads round a corner between two paths without a stop."""

from __future__ import annotations

from dataclasses import dataclass
from math import sin

import numpy as np
from numpy.typing import NDArray

from irlx.motion.curved_path import CurvedPath
from irlx.motion.hermite import Jet, quintic
from irlx.motion.narrow_bends import cuts_about_narrow_bends
from irlx.motion.polynomial_curve import PolynomialCurve
from irlx.motion.pose_path import PosePath
from irlx.motion.rotation_vector import cross
from irlx.motion.sections import Shape
from irlx.motion.turn_curve import TurnCurve, TurnJet

Array = NDArray[np.float64]

SECTIONS = 8
"""Sections of a blend before its corner, and as many behind it, each with a speed of its own; narrow bends
have more."""

_SAMPLES = np.linspace(0.0, 1.0, 33)
_TANGENTS = np.linspace(0.75, 1.45, 15)
_USUAL_TANGENT = 0.9
_REFINEMENTS = 4
_TIE = 1e-6
_POWERS = np.arange(5, -1, -1)
_SLOPES = _POWERS[:-1] * _SAMPLES[:, None] ** np.arange(4, -1, -1)
_BENDS = (_POWERS[:-2] * (_POWERS[:-2] - 1)) * _SAMPLES[:, None] ** np.arange(3, -1, -1)


@dataclass(frozen=True)
class BlendedCorner:
    """A blend, with the parameter `corner` of its point nearest to the corner, and how far that misses it.

    `miss` in m, `miss_angle` in rad; `sections_before` of the sections of `path` come before the corner.
    """

    path: CurvedPath
    corner: float
    miss: float
    miss_angle: float
    sections_before: int

    @property
    def halves(self) -> tuple[Shape, Shape]:
        """What the sections before the corner and those behind it ask for."""
        shape, before = self.path.shape, self.sections_before
        return shape.part(slice(before)), shape.part(slice(before, None))


def blended_corner(before: PosePath, after: PosePath, distance: float) -> BlendedCorner:
    """Blend from `distance` m before the end of one path to as far behind the start of the next.

    Position: the quintic with position, tangent and curvature of both paths at its ends. Orientation: the
    rotation vector from that at the corner is a quintic of the arc length with orientation, rate and change
    of rate of both; between two turns about fixed axes all that bends is the corner.
    """
    leaving, joining = np.array([before.length - distance]), np.array([distance])
    jets = tuple(_jets(path, at) for path, at in ((before, leaving), (after, joining)))
    (start, start_turn), (end, end_turn) = jets
    coefficients = _flattest(start, end)
    curve = PolynomialCurve(np.array([0.0, 1.0]), coefficients[:, None, :])
    corner_rotation = before.end_rotation
    breaks = np.array([0.0, curve.length])
    turns = TurnCurve.through(breaks, corner_rotation[None], [(start_turn, end_turn)])
    nearest = _nearest(curve, before.end_position)
    steps = np.linspace(0.0, 1.0, SECTIONS + 1)
    cuts = np.concatenate([nearest * steps, nearest + (1.0 - nearest) * steps[1:]])
    cuts = cuts_about_narrow_bends(curve, cuts)
    path = CurvedPath(curve, turns, cuts, end.value, end_turn.rotation)
    corner = float(curve.length_at(np.array([nearest]))[0])
    point = curve.points(np.array([nearest]))[0]
    rotation = turns.rotations(np.array([corner]))[0]
    miss = float(np.linalg.norm(point - before.end_position))
    before_corner = int(np.searchsorted(cuts, nearest))
    return BlendedCorner(path, corner, miss, _angle_between(corner_rotation, rotation), before_corner)


def _jets(path: PosePath, s: Array) -> tuple[Jet, TurnJet]:
    poses, (along, rate), (bend, change) = path.poses(s), path.derivatives(s), path.second_derivatives(s)
    return Jet(poses.position[0], along[0], bend[0]), TurnJet(poses.rotation[0], rate[0], change[0])


def _flattest(start: Jet, end: Jet) -> Array:
    """Coefficients (6, 3) of the quintic over 0..1 whose largest curvature is the least.

    Free is the length of the tangents. In units of the circular arc between the ends it is best between 0.87
    (a slight bend) and 1.35 (almost a reversal); the largest curvature is then at most 1.18 times that of a
    circle that touches both ends of a symmetric corner.
    """
    chord = float(np.linalg.norm(end.value - start.value))
    half = 0.5 * _angle(start.rate, end.rate)
    arc = chord * (half / sin(half) if half > 0.0 else 1.0)
    tangents = (arc * _TANGENTS)[:, None]
    ends = [Jet(jet.value, tangents * jet.rate, tangents**2 * jet.bend) for jet in (start, end)]
    candidates = np.transpose(quintic(ends[0], ends[1], 1.0), (1, 0, 2))
    slopes, bends = _SLOPES @ candidates[:, :5], _BENDS @ candidates[:, :4]
    speeds = np.linalg.norm(slopes, axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        curvature = np.linalg.norm(cross(slopes, bends), axis=-1) / speeds**3
    peaks = np.max(np.where(np.isfinite(curvature), curvature, np.inf), axis=1)
    # Straight on all are alike: the one that runs most evenly.
    ties = _TIE / arc * np.abs(_TANGENTS - _USUAL_TANGENT)
    return np.asarray(candidates[int(np.argmin(peaks + ties))])


def _nearest(curve: PolynomialCurve, corner: Array) -> float:
    """Parameter of the curve's point nearest to the corner."""
    low, high = 0.0, 1.0
    for _ in range(_REFINEMENTS):
        u = low + (high - low) * _SAMPLES
        nearest = int(np.argmin(np.linalg.norm(curve.points(u) - corner, axis=1)))
        best = int(np.clip(nearest, 1, len(u) - 2))
        low, high = float(u[best - 1]), float(u[best + 1])
    return 0.5 * (low + high)


def _angle(a: Array, b: Array) -> float:
    return float(np.arctan2(np.linalg.norm(cross(a, b)), a @ b))


def _angle_between(a: Array, b: Array) -> float:
    turned = a.T @ b
    sine = np.array([turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]])
    return float(np.arctan2(np.linalg.norm(sine), np.trace(turned) - 1.0))
