"""The way of a posture along the fibre of its tool pose to the best one for a goal, and what draws it there.

A goal far off the tool pose pulls against the pose. Along the fibre, the postures of that pose, the distance
to it then bends otherwise than W: with C its curvature in a W-orthonormal tangent basis, the largest
|eigenvalue of C - 1| says how much. Above 1 the best posture for the goal may be no minimum, and a tick drawn
at it jumps, or goes to and fro. So what a posture on the way is drawn at is a reference whose pull against
the pose is only a share of the goal's; it has the same best posture.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.slowdown.model import Model
from irlx.transform.posture_flow import FlowEnd, PostureFlow, posture_flow
from irlx.transform.qp.solver import QpSolver

if TYPE_CHECKING:
    from scipy.interpolate import BSpline

Array = NDArray[np.float64]

SAFE_BEND = 0.4
"""Largest |eigenvalue of C - 1| left on the way: what a full step along the fibre leaves of an error."""

_LAST_PIECE = 0.5
"""Length of the way (rad and m) before its end over which the share of the pull comes to 1."""

_ARRIVED = (FlowEnd.NEAREST, FlowEnd.KONF)


@dataclass(frozen=True)
class ReturnWay:
    """Postures from the start, p = 0, to the best one for `goal` (n,), p = 1, rad or m.

    `postures` and `references` are splines over p with values (n,). The best posture with the tool pose of
    the start for references(p) is postures(p); the one for the goal itself is postures(1) where the way is
    `whole`, otherwise the way ends at a posture from which no further one was found.
    """

    goal: Array
    knots: Array
    postures: BSpline
    references: BSpline
    whole: bool

    def reference(self, p: float) -> Array:
        """What draws a posture to postures(p) (n,); the goal's very values at the end of a whole way."""
        return self.goal if self.whole and p >= 1.0 else np.asarray(self.references(p))


def through(goal: Array, postures: Array, references: Array, whole: bool = True) -> ReturnWay:
    """The way through postures (K, n) with their references (K, n), K >= 2; p goes by the way's length."""
    from scipy.interpolate import make_interp_spline

    length = np.cumsum(np.linalg.norm(np.diff(postures, axis=0), axis=1))
    even = np.linspace(0.0, 1.0, len(postures))
    knots = np.append(0.0, length / length[-1]) if np.all(np.diff(length, prepend=0.0) > 0.0) else even
    degree = 3 if len(postures) > 3 else 1
    way, drawn = (make_interp_spline(knots, rows, k=degree) for rows in (postures, references))
    return ReturnWay(goal, knots, way, drawn, whole)


def return_way(model: Model, start: Array, goal: Array, qp: QpSolver) -> ReturnWay | None:
    """Way from posture `start` (n,) to the best one for `goal` (n,) that it slides to with its tool pose.

    None where it is the best one already, or none was found as at a singular posture. Position limits are
    kept; joints that are frozen, or that a limit lets not move, stay.
    """
    arguments = (model.kinematics, start, goal, model.weights, model.limits, model.movable, qp)
    flow = posture_flow(*arguments)
    if len(flow.points) == 1:
        return None
    whole = flow.end in _ARRIVED
    return through(goal, flow.points, _references(flow, goal, whole), whole)


def _references(flow: PostureFlow, goal: Array, whole: bool) -> Array:
    """References (K, n) of the points of a flow.

    The pull goal - q splits W-orthogonally into B B'W (goal - q), along the fibre, and the rest, against the
    pose. Of the rest a share l is kept, which makes the curvature 1 + l (C - 1): as much as leaves a bend of
    `SAFE_BEND`, at the end of a whole way all. There the best posture is a minimum whatever its bend.
    """
    rest, bend = np.empty_like(flow.points), np.empty(len(flow.points))
    for k, point in enumerate(flow.points):
        tangent = flow.fibre.tangent(point)
        rest[k] = goal - point + tangent.basis @ (tangent.basis.T @ tangent.gradient)
        curved = flow.fibre.curvature(point, tangent) - np.eye(tangent.basis.shape[1])
        bend[k] = np.max(np.abs(np.linalg.eigvalsh(curved)), initial=0.0)
    most = np.full(bend.size, SAFE_BEND)
    if whole:
        left = np.cumsum(np.linalg.norm(np.diff(flow.points, axis=0), axis=1)[::-1])[::-1]
        near_end = 1.0 - np.minimum(np.append(left, 0.0) / _LAST_PIECE, 1.0)
        most += near_end * max(bend[-1] - SAFE_BEND, 0.0)
    share = np.minimum(1.0, most / np.maximum(bend, 1e-300))
    return np.asarray(flow.points + share[:, None] * rest)
