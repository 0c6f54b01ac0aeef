"""Postures for a pose far from the present posture: several starts, the nearest solution kept."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from irlx.promises import FOLLOWED_TURN, PATH_ORIENTATION, PATH_POSITION
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.transform.criteria.posture import Posture
from irlx.transform.nearest import Nearest, nearest_from, nearest_in_bounds
from irlx.transform.qp.solver import QpSolver
from irlx.transform.step_bounds import BoundSource, StepBounds
from irlx.transform.tick import TickSolver
from irlx.transform.tick_problem import TickProblem

Array = NDArray[np.float64]

RESTARTS = 16
"""Starts tried beside the present posture; the same ones in every run."""

NEAR = 0.5
"""Way of a joint (rad or m) up to which a posture is near by."""

_SEED = 11
_ITERATIONS = 200
_ALIKE = 1e-9
_WIDE = 100.0


@dataclass(frozen=True)
class PostureSearch:
    """Posture found (n,), or None; how near any start came to the pose.

    `misses` (n,), where there is one: a posture that meets the pose in the coordinates of the task, but not
    in what follows from them, the one that is off by least.
    """

    q: Array | None
    nearest: Nearest
    misses: Array | None = None


def nearest_approach(
    kinematics: Kinematics,
    rotation: Array,
    position: Array,
    q: Array,
    limits: JointLimits,
    free: NDArray[np.bool_],
) -> Iterator[Nearest]:
    """Postures within the position limits that come nearest to a tool pose, one from each start.

    Pose in the world: rotation (3, 3), position (3,) m. Starts are q and `RESTARTS` fixed random
    postures within the limits; frozen joints keep their values. That of q comes first, the others as soon
    as they are found.
    """
    target = kinematics.target(rotation, position)
    lower, upper = limits.position_lower, limits.position_upper
    first, *others = _starts(q, limits, free)
    yield nearest_in_bounds(kinematics, target, first, lower, upper, free)
    yield from (found for _, found in nearest_from(kinematics, target, others, lower, upper, free))


def nearest_posture(
    kinematics: Kinematics,
    qp: QpSolver,
    rotation: Array,
    position: Array,
    q: Array,
    weights: Array,
    limits: JointLimits,
    free: NDArray[np.bool_],
    whole: bool = True,
) -> PostureSearch:
    """Posture at a tool pose that lies nearest to q by the weighted norm, among those of all starts.

    Each start is led onto the pose, then along it towards q by the posture criterion. `whole`: what follows
    from the task's coordinates (`Kinematics.following`) has to be that of the pose, too, to `FOLLOWED_TURN`.
    """
    solver = TickSolver(kinematics, qp, max_iterations=_ITERATIONS)
    target = kinematics.target(rotation, position)
    criterion = Posture(weights, q)
    lower, upper = limits.position_lower, limits.position_upper
    # One by one: side by side they differ by roundings, which would come into streams.
    approaches = [
        nearest_in_bounds(kinematics, target, start, lower, upper, free) for start in _starts(q, limits, free)
    ]
    best: Array | None = None
    misses: Array | None = None
    least = missed = np.inf
    for approach in approaches:
        if approach.distance > PATH_POSITION or approach.angle > PATH_ORIENTATION:
            continue
        problem = TickProblem(target, approach.q, _position_room(approach.q, limits), criterion, free)
        solution = solver.solve(problem)
        away = float(weights @ (solution.q - q) ** 2)
        off = _missed(kinematics, solution.q, target) if whole else 0.0
        if solution.solved and off > FOLLOWED_TURN:
            if off < missed:
                misses, missed = limits.into_positions(solution.q), off
            continue
        if solution.solved and away < least * (1.0 - _ALIKE):
            best, least = limits.into_positions(solution.q), away
    return PostureSearch(best, closest(approaches, kinematics.description.reach), misses)


def _missed(kinematics: Kinematics, q: Array, target: pin.SE3) -> float:
    """Largest turn by which q is off a target in what follows from the task's coordinates, rad."""
    following = kinematics.following
    return float(np.max(np.abs(kinematics.left_of(following, q, target)))) if following.size else 0.0


def posture_near(
    kinematics: Kinematics,
    qp: QpSolver,
    rotation: Array,
    position: Array,
    q: Array,
    weights: Array,
    limits: JointLimits,
    free: NDArray[np.bool_],
    whole: bool = True,
) -> Array | None:
    """Posture at a tool pose as near to q (n,) as Newton's steps from there lead, if that is near by.

    Where no joint goes farther than `NEAR` this is nearly always what `nearest_posture` finds with all its
    starts, at a hundredth of the cost. None where it is not found, or farther away.
    """
    q = limits.into_positions(q)
    target = kinematics.target(rotation, position)
    problem = TickProblem(target, q, _position_room(q, limits), Posture(weights, q), free)
    solution = TickSolver(kinematics, qp).solve(problem, thorough=False)
    if not solution.solved or float(np.max(np.abs(solution.q - q))) > NEAR:
        return None
    if whole and _missed(kinematics, solution.q, target) > FOLLOWED_TURN:
        return None
    return limits.into_positions(solution.q)


def closest(approaches: list[Nearest], reach: float) -> Nearest:
    """The approach that leaves least; distances count divided by the robot's reach (m)."""
    return min(approaches, key=lambda found: (found.distance / reach) ** 2 + found.angle**2)


def _starts(q: Array, limits: JointLimits, free: NDArray[np.bool_]) -> list[Array]:
    random = np.random.default_rng(_SEED)
    # Limits of many turns stand for none: starts drawn from them would all be one noise.
    lower = np.where(limits.position_lower > -_WIDE, limits.position_lower, q - np.pi)
    upper = np.where(limits.position_upper < _WIDE, limits.position_upper, q + np.pi)
    drawn = [np.where(free, random.uniform(lower, upper), q) for _ in range(RESTARTS)]
    return [q, *drawn]


def _position_room(q: Array, limits: JointLimits) -> StepBounds:
    source = np.full(q.size, BoundSource.POSITION, dtype=np.int8)
    return StepBounds(limits.position_lower - q, limits.position_upper - q, source, source)
