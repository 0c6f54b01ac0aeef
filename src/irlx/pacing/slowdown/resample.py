"""Rows at the ticks of a planned clock, brought onto the path."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.motion.pose_path import Poses
from irlx.pacing.slowdown.curve import JointCurve
from irlx.pacing.slowdown.model import Model
from irlx.pacing.slowdown.reserve import rounded_inside
from irlx.robot.limits import JointLimits
from irlx.robot.pose_targets import PoseTargets

Array = NDArray[np.float64]

_ROUNDS = 2
_POOR_SEED = 1e-6
_HAIR = 1e-5
_BACK = 1e-9
_PUT_BACK = 3


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
        q[poor] = model.onto_path(q[poor], targets.chosen(poor), _ROUNDS).q
    if not np.all(np.isfinite(q)):
        raise np.linalg.LinAlgError("a posture of the curve is singular")
    q = _off_limits(model, q, targets)
    if len(s) and s[-1] == curve.s[-1]:
        q[-1] = curve.q[-1]
    return _one_way(rounded_inside(q, model.limits), curve.q[0], model.limits)


def _one_way(q: Array, start: Array, limits: JointLimits) -> Array:
    """Rows (M, n) after `start`, joints that may go one way only kept from going back by rounding."""
    for joint in np.flatnonzero((limits.speed_lower == 0.0) | (limits.speed_upper == 0.0)):
        whole = np.concatenate([start[joint : joint + 1], q[:, joint]])
        only_up = limits.speed_lower[joint] == 0.0
        kept = (np.maximum if only_up else np.minimum).accumulate(whole)[1:]
        if float(np.max(np.abs(kept - q[:, joint]))) <= _BACK:
            q[:, joint] = kept
    return q


def _off_limits(model: Model, q: Array, targets: PoseTargets) -> Array:
    """Joints that their correction led a hair beyond a limit are put back there; others correct instead.

    Of these another may stand on its limit and pass it in turn: it is held as well, once more round.
    """
    held = np.zeros(q.shape, dtype=np.bool_)
    for _ in range(_PUT_BACK):
        beyond = model.limits.into_positions(q) - q
        rows = np.flatnonzero(np.any((beyond != 0.0) & (np.abs(beyond) <= _HAIR), axis=1))
        if rows.size == 0:
            break
        held |= beyond != 0.0
        back = targets.chosen(rows)
        try:
            q[rows] = model.onto_path(q[rows] + beyond[rows], back, _ROUNDS, held[rows]).q
        except np.linalg.LinAlgError:
            break
    return q
