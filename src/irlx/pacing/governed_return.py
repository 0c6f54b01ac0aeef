"""Brings a posture back to a reference over a move, no faster than the joints can do it on the side.

A posture criterion must not pull at a goal far away: under acceleration limits it would overshoot and ring,
without them it would jump. What is pulled at is a reference of its own that starts where the posture is.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from irlx.motion.plan_joint_line import RAMP_TIME
from irlx.motion.trapezoid import Trapezoid
from irlx.pacing.slowdown.model import Model
from irlx.robot.limits import JointLimits
from irlx.transform.compact import Step, StepProblem, bounded_step, free_step, within
from irlx.transform.qp.solver import QpSolver

Array = NDArray[np.float64]

_ON_LIMIT = 1e-9
_NOBODY = np.zeros(0, dtype=np.int8)
_SHARE = 0.5
_PEAK_RATE = 1.875
_PEAK_BEND = 10.0 / 3.0**0.5


def way_to_best(model: Model, q: Array, goal: Array, qp: QpSolver) -> Array:
    """Step (n,) from posture q (n,) to the one nearest to `goal` (n,) with its tool pose, linearised.

    Minimises 1/2 (q + d - goal)' W (q + d - goal) over J d = 0. Joints on a position limit do not go beyond
    it; those that are frozen, or that a limit lets not move, stay. Zero where the posture is the best one
    already, and where it is singular.
    """
    kinematics, limits, free = model.kinematics, model.limits, model.movable
    _, jacobian = kinematics.here(q)
    problem = StepProblem(
        jacobian[:, free],
        np.zeros(kinematics.rows),
        (model.weights * (q - goal))[free],
        model.weights[free],
        np.where(q - limits.position_lower <= _ON_LIMIT, 0.0, -np.inf)[free],
        np.where(limits.position_upper - q <= _ON_LIMIT, 0.0, np.inf)[free],
    )
    way = np.zeros(q.size)
    try:
        d = free_step(problem)
        step = Step(d, _NOBODY) if within(d, problem.lower, problem.upper) else bounded_step(problem, d, qp)
    except np.linalg.LinAlgError:
        return way
    if step is not None:
        way[free] = step.d
    return way


def governed_reference(
    goal: Array, way: Array, law: Trapezoid, limits: JointLimits
) -> Callable[[float], Array]:
    """Reference posture over the path parameter of a move that follows `law`.

    `way` (n,) leads from the posture at the start to the best one for `goal` (n,), see `way_to_best`. The
    reference r(s) = goal - (1 - c(s / length)) way has the posture at the start as its best one, and
    ends `share` of the way to the goal: c rises from 0 to share as a quintic, at rest at both ends.
    The share is 1, or less where a joint would need more than half its speed or acceleration for the
    return alone; the next moves go on from there. Unknown accelerations count as speed / 0.2 s.
    """
    share = _share(np.abs(way), law, limits)

    def reference(s: float) -> Array:
        x = min(max(s / law.length, 0.0), 1.0)
        risen = share * x**3 * (10.0 - 15.0 * x + 6.0 * x**2)
        return np.asarray(goal - (1.0 - risen) * way)

    return reference


def _share(way: Array, law: Trapezoid, limits: JointLimits) -> float:
    """Part of a way (n,) that fits into a move under half of each joint's limits."""
    speed = np.minimum(limits.speed_upper, -limits.speed_lower)
    acc = np.minimum(limits.acceleration_upper, -limits.acceleration_lower)
    acc = np.where(np.isfinite(acc), acc, speed / RAMP_TIME)
    rate, growth = law.speed / law.length, law.acc / law.length
    fastest = _PEAK_RATE * rate
    hardest = _PEAK_BEND * rate**2 + _PEAK_RATE * growth
    with np.errstate(divide="ignore", invalid="ignore"):
        room = np.minimum(_SHARE * speed / (way * fastest), _SHARE * acc / (way * hardest))
    return float(min(np.min(np.where(way > 0.0, room, np.inf)), 1.0))
