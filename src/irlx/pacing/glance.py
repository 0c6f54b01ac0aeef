"""A dry run's look at a motion along a path that nothing stands in the way of.

Where no bound comes near, the postures are a smooth function of the path parameter between the places at
which the path changes its form. They are solved at a few Chebyshev nodes of each such piece, all at once, and
are a polynomial between them, which its last coefficients tell how far to trust. With it *every* tick is held
against the limits. Whatever comes near to one of them, or is not smooth, is none of its business: that is
walked or planned as ever.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dposv

from irlx.motion.chain_path import ChainPath
from irlx.motion.pose_path import PosePath, Poses
from irlx.motion.time_law import TimeLaw
from irlx.pacing.demand import Demands
from irlx.pacing.posture_term import PostureTerm
from irlx.pacing.slowdown.all_at_once import LONGEST, references, settle
from irlx.pacing.slowdown.model import Model
from irlx.robot.limits import JointLimits
from irlx.robot.pose_targets import PoseTargets

Array = NDArray[np.float64]

NODES = 7
"""Chebyshev nodes of a piece, both ends included."""

ATTEMPTS, SPLITS = 3, 2
"""How often pieces that are not smooth enough are cut, and into how many."""

SPEED_SHARE, ACCELERATION_SHARE = 0.98, 0.95
"""Parts of the speed and acceleration limits that a motion may use to be none of a limit's business."""

POSITION_ROOM = 1e-3
"""The same for positions: room (rad or m) to each limit."""

MOST_TAIL = 3e-4
"""Largest last coefficient (rad or m) of a polynomial that is believed."""

MOST_TICKS = 50_000
ROW_STEP = 0.12
"""Largest way of a joint (rad or m) from row to row: what a posture near a singular one is found by."""


@dataclass(frozen=True)
class Glance:
    """Postures q (M, n) of rows at path parameters rising to the end, and the demands (M) that they meet."""

    q: Array
    demands: Demands


@dataclass(frozen=True)
class Glanced:
    """What is looked at: a motion from rest at posture `start` (n,) in `ticks` of `dt` s by `law`."""

    path: PosePath
    law: TimeLaw
    ticks: int
    start: Array
    term: PostureTerm
    dt: float
    first_tick: int


def glance(motion: Glanced, model: Model) -> Glance | Undisturbed | None:
    """Rows of a motion that surely keeps away from all limits; else what it would be without any, where that
    is smooth."""
    if model.freedom < 0 or motion.ticks > MOST_TICKS:
        return None
    breaks = _breaks(motion.path)
    for _ in range(ATTEMPTS):
        curve = _curve(motion, model, breaks)
        if curve is None:
            return None
        rough = curve.tails > MOST_TAIL
        if not np.any(rough):
            return _seen(motion, model, curve)
        breaks = _cut(breaks, rough)
    return None


def _seen(motion: Glanced, model: Model, curve: Undisturbed) -> Glance | Undisturbed:
    if not _is_inside(motion, model.limits, curve):
        return curve
    found = _rows(motion, model, curve)
    return found if _is_clear(motion, model, found) else curve


def _breaks(path: PosePath) -> Array:
    """Values of s at which a path changes its form, both ends included."""
    if isinstance(path, ChainPath):
        inner = path.breaks[1:-1]
        least = 1e-6 * path.length
        kept = [0.0, *(s for s, behind in pairwise([*inner, path.length]) if behind - s > least)]
        return np.array([*kept, path.length])
    return np.array([0.0, path.length])


def _cut(breaks: Array, chosen: NDArray[np.bool_]) -> Array:
    """The breaks (S + 1,) with the chosen pieces (S,) cut into `SPLITS`."""
    parts = np.arange(1, SPLITS) / SPLITS
    new = breaks[:-1][chosen, None] + np.diff(breaks)[chosen, None] * parts
    return np.sort(np.concatenate([breaks, new.ravel()]))


@dataclass(frozen=True)
class Undisturbed:
    """Postures over the path as they would be without bounds.

    Polynomials q(s) between each two of `breaks` (S + 1,), by their `values` (S, NODES, n) at the nodes.

    `nodes` (N + 1,) are the path parameters of all of them, with their `poses`.
    """

    breaks: Array
    values: Array
    nodes: Array
    poses: Poses

    def at(self, s: Array) -> Array:
        """Postures (M, n) at path parameters s (M,)."""
        piece = np.clip(np.searchsorted(self.breaks, s, side="right") - 1, 0, len(self.values) - 1)
        begin = self.breaks[piece]
        weights = _barycentric((s - begin) / (self.breaks[piece + 1] - begin))
        if len(self.values) == 1:
            return np.asarray(weights @ self.values[0])
        return np.asarray((weights[:, None, :] @ self.values[piece])[:, 0])

    @cached_property
    def tails(self) -> Array:
        """Largest of the last two Chebyshev coefficients of a joint (rad or m), of each piece (S,)."""
        return np.asarray(np.max(np.abs(_TAIL @ self.values), axis=(1, 2)))


_ANGLES = np.pi * np.arange(NODES) / (NODES - 1)
_AT = 0.5 * (1.0 - np.cos(_ANGLES))
_SIGNS = np.where(np.arange(NODES) % 2 == 0, 1.0, -1.0) * np.where(
    (np.arange(NODES) == 0) | (np.arange(NODES) == NODES - 1), 0.5, 1.0
)
_TAIL = (
    np.array([np.cos(k * _ANGLES) for k in (NODES - 2, NODES - 1)])
    * np.abs(_SIGNS)
    * np.array([[2.0], [1.0]])
    / (NODES - 1)
)
"""Rows that give the last two coefficients of values at the nodes, but for their signs."""


def _barycentric(x: Array) -> Array:
    """Weights (M, NODES) of the values at the nodes for the value at x (M,) in 0 .. 1."""
    off = x[:, None] - _AT
    on = off == 0.0
    weights = _SIGNS / np.where(on, 1.0, off)
    exact = np.any(on, axis=1)
    weights[exact] = on[exact]
    return np.asarray(weights / np.sum(weights, axis=1, keepdims=True))


def _curve(motion: Glanced, model: Model, breaks: Array) -> Undisturbed | None:
    """Postures over the path; None where they are not found at once."""
    nodes = np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * _AT[:-1]).ravel(), breaks[-1])
    criteria = [
        motion.term.at(float(s), float(way)) for s, way in zip(nodes[1:], np.diff(nodes), strict=True)
    ]
    drawn = references(criteria)
    if drawn is None:
        return None
    poses = motion.path.poses(nodes)
    targets = model.targets(poses)
    q = _predicted(model, motion.start, targets, drawn)
    if q is None or not settle(model, q, targets, drawn):
        return None
    number = np.arange(len(breaks) - 1)[:, None] * (NODES - 1) + np.arange(NODES)
    return Undisturbed(breaks, q[number], nodes, poses)


def _predicted(model: Model, start: Array, targets: PoseTargets, drawn: Array) -> Array | None:
    """Postures (N + 1, n) near those of the nodes: one Newton step from each to the next."""
    free, difference = model.free, model.kinematics.difference
    inverse = free / model.weights
    q = np.empty((len(targets), start.size))
    q[0] = here = start
    for k, target in enumerate(targets[1:], start=1):
        twist, jacobian = difference(here, target)
        scaled = jacobian * inverse
        pull = free * (drawn[k - 1] - here) if len(drawn) else 0.0 * here
        _, multipliers, failed = dposv(scaled.dot(jacobian.T), twist - jacobian.dot(pull))
        step = pull + multipliers.dot(scaled)
        if failed or not step.dot(step) <= LONGEST**2 * start.size:
            return None
        q[k] = here = here + step
    return q


def _is_inside(motion: Glanced, limits: JointLimits, curve: Undisturbed) -> bool:
    """Whether the ticks of a motion keep well away from all limits, by the differences of a run."""
    dt = motion.dt
    s, _ = motion.law.evaluate(dt * np.arange(1.0, motion.ticks + 1.0))
    rows = curve.at(s)
    if np.any(rows > limits.position_upper - POSITION_ROOM) or np.any(
        rows < limits.position_lower + POSITION_ROOM
    ):
        return False
    rest = np.vstack([motion.start, motion.start, rows, rows[-1:]])
    speeds = np.diff(rest, axis=0) / dt
    accelerations = np.diff(speeds, axis=0) / dt
    return _within(speeds, limits.speed_lower, limits.speed_upper, SPEED_SHARE) and _within(
        accelerations, limits.acceleration_lower, limits.acceleration_upper, ACCELERATION_SHARE
    )


def _is_clear(motion: Glanced, model: Model, found: Glance) -> bool:
    """Whether the rows come too near to nothing."""
    if model.clearance is None:
        return True
    elapsed = motion.dt * np.asarray(found.demands.tick - motion.first_tick + 1, dtype=np.float64)
    return model.clearance.first_short(found.q, motion.start, elapsed) is None


def _within(values: Array, lower: Array, upper: Array, share: float) -> bool:
    return bool(np.all(values.max(axis=0) <= share * upper) and np.all(values.min(axis=0) >= share * lower))


def _rows(motion: Glanced, model: Model, curve: Undisturbed) -> Glance:
    """Rows at the nodes, and more between them where the joints go far from one to the next."""
    nodes, values = curve.nodes, curve.values
    counts = np.ceil(np.max(np.abs(np.diff(values, axis=1)), axis=2).ravel() / ROW_STEP).astype(int)
    if np.all(counts <= 1):
        poses = Poses(curve.poses.position[1:], curve.poses.rotation[1:])
        return Glance(_joined(values), _demands(motion, nodes[1:], poses))
    ways = zip(nodes[:-1], nodes[1:], counts, strict=True)
    s = np.concatenate([np.linspace(first, last, max(count, 1) + 1)[1:] for first, last, count in ways])
    q = curve.at(s)
    q[:, ~model.free], q[-1] = motion.start[~model.free], values[-1, -1]
    return Glance(q, _demands(motion, s, motion.path.poses(s)))


def _joined(values: Array) -> Array:
    """The postures at all nodes of pieces (S, NODES, n) but the first."""
    return np.asarray(values[:, 1:].reshape(-1, values.shape[2]))


def _demands(motion: Glanced, s: Array, poses: Poses) -> Demands:
    """Demands at path parameters; of their twists, which a dry run has no use for, nothing is said."""
    ticks = np.clip(np.ceil(motion.law.times_at(s) / motion.dt - 1e-9).astype(int), 1, motion.ticks)
    ticks[-1] = motion.ticks
    unknown = np.full((len(s), 6), np.nan)
    return Demands(ticks + motion.first_tick - 1, s, poses.position, poses.rotation, unknown)
