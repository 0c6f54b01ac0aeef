"""Rows at the ticks of a planned clock, brought onto the path."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from irlx.motion.pose_path import Poses
from irlx.pacing.slowdown.curve import JointCurve
from irlx.pacing.slowdown.model import Model
from irlx.pacing.slowdown.reserve import rounded_inside

Array = NDArray[np.float64]

_ROUNDS = 2
_POOR_SEED = 1e-6
_HAIR = 1e-5


def resample(model: Model, curve: JointCurve, s: Array, poses: Poses) -> Array:
    """Postures (M, n) at path parameters s (M,), on the poses asked for there.

    Always the same number of Newton steps from the curve: a stop at a tolerance would come back from
    second differences as 4 tolerance / dt^2. A poor seed (near a singular posture) gets two more. The
    last row is the last knot itself. Raises numpy.linalg.LinAlgError at a singular posture.
    """
    targets = model.targets(poses)
    q, twists, _ = model.onto_path(curve.at(s), targets, _ROUNDS)
    poor = np.flatnonzero(np.max(np.abs(twists), axis=1) > _POOR_SEED)
    if poor.size:
        q[poor] = model.onto_path(q[poor], [targets[k] for k in poor], _ROUNDS).q
    q = _off_limits(model, q, targets)
    if len(s) and s[-1] == curve.s[-1]:
        q[-1] = curve.q[-1]
    return rounded_inside(q, model.limits)


def _off_limits(model: Model, q: Array, targets: list[pin.SE3]) -> Array:
    """Joints that their correction led a hair beyond a limit are put back there; others correct instead."""
    beyond = model.limits.into_positions(q) - q
    rows = np.flatnonzero(np.any((beyond != 0.0) & (np.abs(beyond) <= _HAIR), axis=1))
    if rows.size:
        held = beyond[rows] != 0.0
        try:
            q[rows] = model.onto_path(q[rows] + beyond[rows], [targets[k] for k in rows], _ROUNDS, held).q
        except np.linalg.LinAlgError:
            return q
    return q
