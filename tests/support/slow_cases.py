"""Lines that slow down under drawn limits, walked: what the stages after the elastic walk begin with."""

from __future__ import annotations

from functools import cache

import numpy as np
from scipy.spatial.transform import Rotation

from irlx.motion.trapezoid import Trapezoid
from irlx.pacing.slowdown.elastic_walk import Passage, elastic_walk
from irlx.pacing.slowdown.grid import PathGrid, path_grid
from irlx.pacing.slowdown.reserve import RESERVE, reserved
from irlx.robot.limits import JointLimits
from irlx.transform.criteria.least_motion import LeastMotion
from irlx.verifier.geometry.forward import forward
from machines import Machine, least_motion, machine

WAYS = {"arm7": (0.0, -0.25, 0.05), "koch11": (-1.2, 0.8, 0.3)}
SPEEDS = {"arm7": (0.25, 1.5), "koch11": (1.0, 4.0)}


@cache
def grid_of(name: str) -> PathGrid:
    robot = machine(name)
    path = robot.line(WAYS[name], (0.1, -0.2, 0.15))
    return path_grid(path, Trapezoid.fastest(path.length, *SPEEDS[name]))


_WALKED: dict[tuple, Passage] = {}


def walked(name: str, limits: JointLimits, frozen: tuple[int, ...] = ()) -> Passage:
    """The elastic walk with the usual reserve, each made once; nobody may change it."""
    sides = [side.tobytes() for kind in ("position", "speed", "acceleration") for side in limits.pair(kind)]
    asked = name, *sides, frozen
    if asked not in _WALKED:
        _WALKED[asked] = _walked(name, limits, frozen)
        _WALKED[asked].q.flags.writeable = False
    return _WALKED[asked]


def _walked(name: str, limits: JointLimits, frozen: tuple[int, ...]) -> Passage:
    robot, grid = machine(name), grid_of(name)
    least = LeastMotion(robot.weights)
    bounds = reserved(limits, grid.intervals + 1, RESERVE)
    return elastic_walk(robot.model(limits, frozen), grid, robot.start, lambda s, _: least, bounds, RESERVE)


@cache
def free_rows(name: str) -> np.ndarray:
    robot, grid = machine(name), grid_of(name)
    return np.vstack([robot.start, least_motion(robot, tail(grid.poses), robot.start)])


def tail(poses):
    return type(poses)(poses.position[1:], poses.rotation[1:])


def used(name: str) -> np.ndarray:
    """Largest speed of each joint without limits."""
    return np.max(np.abs(np.diff(free_rows(name), axis=0)) / grid_of(name).times[:, None], axis=0)


def jacobian_at(robot: Machine, q: np.ndarray) -> np.ndarray:
    """Tool Jacobian (6, n) by central differences of the verifier's forward kinematics."""
    h, steps = 1e-6, 1e-6 * np.eye(robot.n)
    ahead, behind = forward(robot.robot, q + steps), forward(robot.robot, q - steps)
    turns = Rotation.from_matrix(ahead[1] @ np.swapaxes(behind[1], 1, 2)).as_rotvec()
    return np.vstack([(ahead[0] - behind[0]).T, turns.T]) / (2.0 * h)


def slow_limits(name: str, share: float, seed: int = 0, cut: bool = True) -> JointLimits:
    """Speeds at a share of the use, ranges that the free motion just passes, accelerations."""
    robot, rng = machine(name), np.random.default_rng(seed)
    rows, fast = free_rows(name), used(name) * share * rng.uniform(0.9, 1.6, machine(name).n)
    margin = 0.3 * (rows.max(axis=0) - rows.min(axis=0)) + 1e-3
    lower, upper = np.minimum(rows.min(axis=0), robot.start) - margin, rows.max(axis=0) + margin
    # The joint that can best give way is cut on the side it moves to.
    joint = int(np.argmax(np.abs(np.linalg.svd(jacobian_at(robot, rows[len(rows) // 2]))[2][6:]).max(axis=0)))
    if rows[-1, joint] > rows[0, joint]:
        upper[joint] = max(rows[:, joint].max() - 0.05 * margin[joint], robot.start[joint])
    else:
        lower[joint] = min(rows[:, joint].min() + 0.05 * margin[joint], robot.start[joint])
    limits = robot.unlimited().with_pair("speed", -fast, fast)
    limits = limits.with_pair("position", lower, upper) if cut else limits
    hard = np.full(robot.n, 20.0)
    return limits.with_pair("acceleration", -hard, hard)
