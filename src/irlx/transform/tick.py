"""One tick of the inverse transform: Newton-Raphson from the last posture to the demanded pose."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics
from irlx.transform.compact import Step, StepProblem, bounded_step, free_step, within
from irlx.transform.criteria.criterion import Criterion
from irlx.transform.criterion_pace import CriterionPace
from irlx.transform.nearest import Nearest, damped_step, nearest_in_bounds, scaled_singular_values
from irlx.transform.precision import (
    AT_BOUND,
    FINAL_CLIP,
    MAX_ITERATIONS,
    MAX_NEWTON_STEP,
    ORIENTATION_TOLERANCE,
    POSITION_TOLERANCE,
    SETTLED_STEP,
    SINGULAR_RATIO,
)
from irlx.transform.qp.solver import QpSolver
from irlx.transform.step_bounds import StepBounds

Array = NDArray[np.float64]


class TickStatus(Enum):
    """How a tick ended."""

    SOLVED = "solved"
    BOUNDS_CONFLICT = "bounds of a joint contradict each other"
    NO_STEP = "no step keeps path and bounds"
    NOT_CONVERGED = "the pose is not met"


@dataclass(frozen=True)
class TickProblem:
    """All that one tick depends on.

    `target`: demanded tool pose in the world; `q` (n,): posture at the start of the tick; `bounds`
    of the step; `criterion` in force; `free` (n,) bool: joints that are not frozen.
    """

    target: pin.SE3
    q: Array
    bounds: StepBounds
    criterion: Criterion
    free: NDArray[np.bool_]


@dataclass(frozen=True)
class TickSolution:
    """Posture q (n,) at the end of a tick, and how it was found.

    `active` is +1 / -1 for joints held at the upper / lower bound of their step. `twist` (6,) is
    what is left to the demanded pose: before the last step where the tick is solved, else at q, the
    posture within the bounds that comes nearest.
    """

    status: TickStatus
    q: Array
    active: NDArray[np.int8]
    twist: Array
    iterations: int

    @property
    def solved(self) -> bool:
        """Whether q is on the path and inside every bound."""
        return self.status is TickStatus.SOLVED


class TickSolver:
    """Solves ticks of one robot; holds no state from one tick to the next but solver workspaces."""

    def __init__(self, kinematics: Kinematics, qp: QpSolver, max_iterations: int = MAX_ITERATIONS) -> None:
        self.kinematics = kinematics
        self._max_iterations = max_iterations
        self.reach = kinematics.description.reach
        self._qp = qp

    def solve(self, problem: TickProblem) -> TickSolution:
        """Find the posture on the demanded pose that makes the criterion smallest within the bounds.

        A tick is solved once a Newton step starts from a pose error within tolerance and moves no
        joint by more than `SETTLED_STEP`: that last step squares what was left.
        """
        if problem.bounds.conflicts.size:
            nothing = np.zeros(problem.q.size, dtype=np.int8)
            return TickSolution(TickStatus.BOUNDS_CONFLICT, problem.q, nothing, np.zeros(6), 0)
        first = self._newton(problem, np.zeros(problem.q.size))
        if isinstance(first, TickSolution):
            return first
        # Bounds can close the way that the first linear step sees and leave another one open.
        nearest = self._nearest(problem)
        if _met(nearest.twist):
            second = self._newton(problem, nearest.q - problem.q)
            if isinstance(second, TickSolution):
                return second
        return self._unsolved(problem, nearest, first)

    def _newton(self, problem: TickProblem, whole: Array) -> TickSolution | TickStatus:
        """Iterate from `whole` (step since the start of the tick); the status says why it failed."""
        bounds = problem.bounds
        pace = CriterionPace()
        for iteration in range(1, self._max_iterations + 1):
            step_problem, d_free = self.newton_problem(problem, whole)
            step = self._step(step_problem, d_free)
            if step is None:
                return TickStatus.NO_STEP
            d = pace.shape(step_problem, step.d)
            d = d * min(1.0, MAX_NEWTON_STEP / max(float(np.max(np.abs(d), initial=0.0)), 1e-300))
            whole = whole.copy()
            whole[problem.free] += d
            clipped = np.clip(whole, bounds.lower, bounds.upper)
            moved = float(np.max(np.abs(d), initial=0.0))
            if moved <= SETTLED_STEP and _met(step_problem.twist):
                return self._finish(problem, whole, clipped, step, step_problem.twist, iteration)
            whole = np.where(problem.free, clipped, 0.0)
        return TickStatus.NOT_CONVERGED

    def newton_problem(self, problem: TickProblem, whole: Array) -> tuple[StepProblem, Array]:
        """The Newton step at the iterate `whole` (step since the start of the tick), free joints only.

        Returns the problem and its minimiser without bounds (damped near a singular posture).
        """
        free = problem.free
        twist, jacobian = self.kinematics.difference(problem.q + whole, problem.target)
        step_problem = StepProblem(
            jacobian[:, free],
            twist,
            problem.criterion.gradient(problem.q, whole)[free],
            problem.criterion.hessian()[free],
            (problem.bounds.lower - whole)[free],
            (problem.bounds.upper - whole)[free],
        )
        try:
            d_free = free_step(step_problem)
        except np.linalg.LinAlgError:
            return step_problem, damped_step(step_problem, self.reach)
        if float(np.max(np.abs(d_free), initial=0.0)) > MAX_NEWTON_STEP:
            values = scaled_singular_values(step_problem.jacobian, self.reach)
            if values[-1] < SINGULAR_RATIO * values[0]:
                return step_problem, damped_step(step_problem, self.reach)
        return step_problem, d_free

    def _step(self, problem: StepProblem, d_free: Array) -> Step | None:
        if within(d_free, problem.lower, problem.upper):
            return Step(d_free, np.zeros(d_free.size, dtype=np.int8))
        return bounded_step(problem, d_free, self._qp)

    def _finish(
        self, problem: TickProblem, whole: Array, clipped: Array, step: Step, twist: Array, iterations: int
    ) -> TickSolution:
        if float(np.max(np.abs(whole - clipped)[problem.free], initial=0.0)) > FINAL_CLIP:
            raise ArithmeticError("a converged tick left its bounds: the QP solver is at fault")
        active = np.zeros(problem.q.size, dtype=np.int8)
        active[problem.free] = step.active
        q = np.where(problem.free, problem.q + clipped, problem.q)
        return TickSolution(TickStatus.SOLVED, q, active, twist, iterations)

    def _nearest(self, problem: TickProblem) -> Nearest:
        lower, upper = problem.q + problem.bounds.lower, problem.q + problem.bounds.upper
        return nearest_in_bounds(self.kinematics, problem.target, problem.q, lower, upper, problem.free)

    def _unsolved(self, problem: TickProblem, nearest: Nearest, status: TickStatus) -> TickSolution:
        bounds, whole = problem.bounds, nearest.q - problem.q
        at_upper, at_lower = bounds.upper - whole <= AT_BOUND, whole - bounds.lower <= AT_BOUND
        active = np.where(at_upper, 1, np.where(at_lower, -1, 0)).astype(np.int8)
        active[~problem.free] = 0
        return TickSolution(status, nearest.q, active, nearest.twist, self._max_iterations)


def _met(twist: Array) -> bool:
    return bool(
        np.sqrt(twist[:3] @ twist[:3]) <= POSITION_TOLERANCE
        and np.sqrt(twist[3:] @ twist[3:]) <= ORIENTATION_TOLERANCE
    )
