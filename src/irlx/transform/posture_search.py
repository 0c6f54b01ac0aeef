"""Postures for a pose far from the present posture: several starts, the nearest solution kept."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.transform.criteria.posture import Posture
from irlx.transform.qp.solver import QpSolver
from irlx.transform.step_bounds import BoundSource, StepBounds
from irlx.transform.tick import TickProblem, TickSolver

Array = NDArray[np.float64]

RESTARTS = 16
"""Starts tried beside the present posture; the same ones in every run."""

_SEED = 11
_ITERATIONS = 200


@dataclass(frozen=True)
class Shortfall:
    """How near the tool comes to a pose out of reach: posture (n,), distance m, angle rad."""

    q: Array
    distance: float
    angle: float


def nearest_posture(
    kinematics: Kinematics,
    qp: QpSolver,
    rotation: Array,
    position: Array,
    q: Array,
    weights: Array,
    limits: JointLimits,
    free: NDArray[np.bool_],
) -> Array | None:
    """Posture at a tool pose that lies nearest to q by the weighted norm, None where none was found.

    Pose in the world: rotation (3, 3), position (3,) m. Searched from q and `RESTARTS` fixed random
    postures within the position limits; frozen joints keep their values.
    """
    solver = TickSolver(kinematics, qp, max_iterations=_ITERATIONS)
    target = kinematics.target(rotation, position)
    criterion = Posture(weights, q)
    best: Array | None = None
    least = np.inf
    for start in _starts(q, limits, free):
        problem = TickProblem(target, start, _position_room(start, limits), criterion, free)
        solution = solver.solve(problem)
        away = float(weights @ (solution.q - q) ** 2)
        if solution.solved and away < least * (1.0 - 1e-9):
            best, least = solution.q, away
    return best


def _starts(q: Array, limits: JointLimits, free: NDArray[np.bool_]) -> list[Array]:
    random = np.random.default_rng(_SEED)
    lower = np.where(np.isfinite(limits.position_lower), limits.position_lower, q - np.pi)
    upper = np.where(np.isfinite(limits.position_upper), limits.position_upper, q + np.pi)
    drawn = [np.where(free, random.uniform(lower, upper), q) for _ in range(RESTARTS)]
    return [q, *drawn]


def _position_room(q: Array, limits: JointLimits) -> StepBounds:
    source = np.full(q.size, BoundSource.POSITION, dtype=np.int8)
    return StepBounds(limits.position_lower - q, limits.position_upper - q, source, source)


def shortfall(
    kinematics: Kinematics,
    rotation: Array,
    position: Array,
    q: Array,
    limits: JointLimits,
    free: NDArray[np.bool_],
) -> Shortfall:
    """The posture within the limits, over all starts, that comes nearest to a pose out of reach.

    Nearest by |log6| of the pose difference, its translation divided by the robot's reach.
    """
    target = kinematics.target(rotation, position)
    scale = np.array([1.0 / kinematics.description.reach] * 3 + [1.0] * 3)
    lower, upper = limits.position_lower[free], limits.position_upper[free]
    movable = lower < upper

    def posture(start: Array, x: Array) -> Array:
        full: Array = start.copy()
        part: Array = start[free]
        part[movable] = x
        full[free] = part
        return full

    def residual(x: Array, start: Array) -> Array:
        return np.asarray(scale * kinematics.difference(posture(start, x), target)[0])

    best: Shortfall | None = None
    least = np.inf
    for start in _starts(q, limits, free):
        bounds = (lower[movable], upper[movable])
        x = np.clip(start[free][movable], *bounds)
        result = least_squares(residual, x, bounds=bounds, args=(start,), max_nfev=60)
        if result.cost < least:
            least = result.cost
            found = posture(start, result.x)
            _, tool_position = kinematics.tool_pose(found)
            turn = kinematics.difference(found, target)[0][3:]
            distance = float(np.linalg.norm(tool_position - position))
            best = Shortfall(found, distance, float(np.linalg.norm(turn)))
    if best is None:
        raise ArithmeticError("no start to search from")
    return best
