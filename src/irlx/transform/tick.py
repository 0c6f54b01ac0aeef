"""One tick of the inverse transform: Newton-Raphson from the last posture to the demanded pose."""

from __future__ import annotations

from copy import copy
from enum import Enum
from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics
from irlx.transform.compact import Step, StepProblem, bounded_step, free_step
from irlx.transform.criteria.restrained import Restrained
from irlx.transform.criterion_pace import CriterionPace
from irlx.transform.holding_back import HoldingBack
from irlx.transform.metric import solved
from irlx.transform.nearest import Nearest, damped_step, nearest_in_bounds, scaled_singular_values
from irlx.transform.precision import (
    AT_BOUND,
    MAX_ITERATIONS,
    MAX_NEWTON_STEP,
    RESTRAINTS,
    SINGULAR_RATIO,
    TOUCHED_POSE,
)
from irlx.transform.qp.solver import QpSolver
from irlx.transform.second_start import middle_of_bounds
from irlx.transform.settling import Settling, is_met
from irlx.transform.tick_problem import TickProblem, build_tick
from irlx.transform.undisturbed import UndisturbedTick

Array = NDArray[np.float64]


class TickStatus(Enum):
    """How a tick ended."""

    SOLVED = "solved"
    BOUNDS_CONFLICT = "bounds of a joint contradict each other"
    NO_STEP = "no step keeps path and bounds"
    NOT_CONVERGED = "the pose is not met"
    TOO_NEAR = "no step keeps clear"


class TickSolution(NamedTuple):
    """Posture q (n,) at the end of a tick, and how it was found.

    `active` is +1 / -1 for joints held at the upper / lower bound of their step. `twist` (m,) is
    what is left of the demand: before the last step where the tick is solved, else at q, the
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
    """Solves ticks of one robot; holds no state from one tick to the next but solver workspaces.

    One that is `restraining` also remembers how far the tick before held its criterion back.

    `runs_free` tells that a tick without disturbance is that of `undisturbed`.
    """

    runs_free = True

    def __init__(self, kinematics: Kinematics, qp: QpSolver, max_iterations: int = MAX_ITERATIONS) -> None:
        self.kinematics = kinematics
        self._max_iterations = max_iterations
        self._linear = kinematics.task.linear
        self._qp = qp
        self._plain_for = np.ones(kinematics.joints, dtype=bool)
        self._plain = UndisturbedTick(kinematics, self._plain_for, max_iterations)
        self._holding_back: HoldingBack | None = None

    def restraining(self) -> TickSolver:
        """The same for one walk, holding a criterion back where a thorough search finds no step that settles.

        To find out that it must takes many times as long as a tick does, so it begins the ticks that follow
        one of them in the same way, see `HoldingBack`. It asks less of the criterion than the move does.
        """
        found = copy(self)
        found._holding_back = HoldingBack()
        return found

    def solve(self, problem: TickProblem, seed: Array | None = None, thorough: bool = True) -> TickSolution:
        """Find the posture on the demanded pose that makes the criterion smallest within the bounds.

        A tick is solved once a Newton step starts from a pose error within tolerance and leaves less
        than `SETTLED_ERROR` of the criterion's minimum: that last step squares what was left of the pose.
        `seed` (n,) is a guess of the whole step; it saves Newton steps and decides nothing. Without
        `thorough` a tick counts as unsolved where Newton's steps find nothing; what is left then is not
        looked for.
        """
        begun = problem.criterion.begun(problem.q)
        if begun is not problem.criterion:
            problem = problem._replace(criterion=begun)
        start = np.zeros(problem.q.size) if seed is None else seed
        held_back = self._held_back(problem, start)
        if held_back is not None:
            return held_back
        found = self._undisturbed(problem, start)
        if isinstance(found, TickSolution):
            return found
        if problem.bounds.conflicts.size:
            nothing = np.zeros(problem.q.size, dtype=np.int8)
            return TickSolution(TickStatus.BOUNDS_CONFLICT, problem.q, nothing, self._no_rows(), 0)
        first = self._newton(problem, found)
        if not isinstance(first, TickSolution) and seed is not None:
            # A seed must not decide whether there is a step.
            first = self._newton(problem, np.zeros(problem.q.size))
        if isinstance(first, TickSolution):
            return first
        if not thorough:
            nothing = np.zeros(problem.q.size, dtype=np.int8)
            return TickSolution(first, problem.q, nothing, self._no_rows(), self._max_iterations)
        # Bounds can close the way that the first linear step sees and leave another one open.
        nearest = self._nearest(problem)
        second = self._from_elsewhere(problem, nearest)
        if second is not None:
            return second
        if problem.clearance is not None:
            unaware = self.solve(problem._replace(clearance=None))
            if unaware.solved:
                # The bounds leave a way: what comes too near closes it.
                return unaware._replace(status=TickStatus.TOO_NEAR)
        return self._unsolved(problem, nearest, first)

    def _undisturbed(self, problem: TickProblem, whole: Array) -> TickSolution | Array:
        """Newton steps from `whole` (n,) without precautions, or the iterate to go on from with them."""
        target, q, bounds, criterion, free, clearance = problem
        plain = self.undisturbed(free)
        found, step, twist, iteration = plain.solve(target, q, whole, criterion, bounds)
        if not found or (clearance is not None and not clearance.kept(step)):
            return step
        active = np.zeros(q.size, dtype=np.int8)
        return TickSolution(TickStatus.SOLVED, plain.reached(q, step), active, twist, iteration)

    def undisturbed(self, free: NDArray[np.bool_]) -> UndisturbedTick:
        """What solves ticks of this robot that nothing stands against, where the joints `free` (n,) move."""
        if free is not self._plain_for:
            self._plain = UndisturbedTick(self.kinematics, free, self._max_iterations)
            self._plain_for = free
        return self._plain

    def _newton(self, problem: TickProblem, whole: Array) -> TickSolution | TickStatus:
        """Iterate from `whole` (step since the start of the tick); the status says why it failed."""
        lower, upper, free = problem.bounds.lower, problem.bounds.upper, problem.free
        # An iterate inside the bounds has steps that stay inside; frozen joints have no part in them.
        whole = np.where(free, np.minimum(np.maximum(whole, lower), upper), 0.0)
        settling, pace = Settling(), CriterionPace()
        for iteration in range(1, self._max_iterations + 1):
            step_problem, d_free = self.newton_problem(problem, whole)
            step = self._step(step_problem, d_free)
            if step is None:
                return TickStatus.NO_STEP
            pull = solved(step_problem.hessian, step_problem.gradient)
            done = settling.after(_length(step.d), _length(pull), self._met(step_problem.twist))
            done = done or (iteration == self._max_iterations and settling.calm > 0)
            d = step.d if done else pace.shape(step_problem, step)
            d = d * min(1.0, MAX_NEWTON_STEP / max(float(np.max(np.abs(d), initial=0.0)), 1e-300))
            whole = whole.copy()
            whole[free] += d
            whole = np.where(free, np.minimum(np.maximum(whole, lower), upper), 0.0)
            if done and problem.clearance is not None and not problem.clearance.kept(whole):
                if problem.clearance.exhausted:
                    return TickStatus.TOO_NEAR
                continue
            if done:
                active = np.zeros(problem.q.size, dtype=np.int8)
                active[free] = step.active
                q = np.where(free, problem.q + whole, problem.q)
                return TickSolution(TickStatus.SOLVED, q, active, step_problem.twist, iteration)
        return TickStatus.NOT_CONVERGED

    def _held_back(self, problem: TickProblem, start: Array) -> TickSolution | None:
        """A step with the criterion held back as a tick before needed it, None where this is not due."""
        if self._holding_back is None or problem.bounds.conflicts.size:
            return None
        restraint = self._holding_back.begin()
        if restraint is None:
            return None
        found = self._newton(_with_restraint(problem, restraint), start)
        if isinstance(found, TickSolution):
            return found
        self._holding_back.failed()
        return None

    def _from_elsewhere(self, problem: TickProblem, nearest: Nearest) -> TickSolution | None:
        """A tick that Newton's steps from its start do not find; None where they find it from nowhere.

        `nearest` is the posture within the bounds that a search from the start brings nearest to the pose.
        """
        met = self._met(nearest.twist)
        starts = [nearest.q - problem.q] if met else []
        for start in [*starts, *middle_of_bounds(problem.bounds)]:
            found = self._newton(problem, start)
            if isinstance(found, TickSolution):
                return found
        if not met:
            return None
        touched = self._touched(problem, nearest)
        return self._restrained(problem) if touched is None else touched

    def _touched(self, problem: TickProblem, nearest: Nearest) -> TickSolution | None:
        """The tick where its bounds miss the pose by a rounding only: then the pose that they let be met."""
        missed = nearest.twist * self.kinematics.row_scale
        if missed.dot(missed) > TOUCHED_POSE**2:
            return None
        pose = self.kinematics.target(*self.kinematics.tool_pose(nearest.q))
        found = self._newton(problem._replace(target=pose), nearest.q - problem.q)
        return found if isinstance(found, TickSolution) else None

    def _restrained(self, problem: TickProblem) -> TickSolution | None:
        """A step on the path with the criterion held back, as little as will do; None where there is none.

        The path must not pay for a criterion on whose minimum the steps do not settle.
        """
        if self._holding_back is None:
            return None
        nothing = np.zeros(problem.q.size)
        for restraint in RESTRAINTS:
            found = self._newton(_with_restraint(problem, restraint), nothing)
            if isinstance(found, TickSolution):
                self._holding_back.needed(restraint)
                return found
        return None

    def newton_problem(self, problem: TickProblem, whole: Array) -> tuple[StepProblem, Array]:
        """The Newton step at the iterate `whole` (step since the start of the tick), free joints only.

        Returns the problem and its minimiser without bounds (damped near a singular posture).
        """
        step_problem = build_tick(self.kinematics, problem, whole)
        try:
            d_free = free_step(step_problem)
        except np.linalg.LinAlgError:
            return step_problem, damped_step(step_problem, self.kinematics.row_scale)
        if float(np.max(np.abs(d_free), initial=0.0)) > MAX_NEWTON_STEP:
            values = scaled_singular_values(step_problem.jacobian, self.kinematics.row_scale)
            if values[-1] < SINGULAR_RATIO * values[0]:
                return step_problem, damped_step(step_problem, self.kinematics.row_scale)
        return step_problem, d_free

    def _step(self, problem: StepProblem, d_free: Array) -> Step | None:
        if problem.keeps(d_free):
            return Step(d_free, np.zeros(d_free.size, dtype=np.int8))
        return bounded_step(problem, d_free, self._qp)

    def _nearest(self, problem: TickProblem) -> Nearest:
        lower, upper = problem.q + problem.bounds.lower, problem.q + problem.bounds.upper
        return nearest_in_bounds(self.kinematics, problem.target, problem.q, lower, upper, problem.free)

    def _met(self, left: Array) -> bool:
        return is_met(left, self._linear)

    def _no_rows(self) -> Array:
        return np.zeros(self.kinematics.rows)

    def _unsolved(self, problem: TickProblem, nearest: Nearest, status: TickStatus) -> TickSolution:
        bounds, whole = problem.bounds, nearest.q - problem.q
        at_upper, at_lower = bounds.upper - whole <= AT_BOUND, whole - bounds.lower <= AT_BOUND
        active = np.where(at_upper, 1, np.where(at_lower, -1, 0)).astype(np.int8)
        active[~problem.free] = 0
        return TickSolution(status, nearest.q, active, nearest.twist, self._max_iterations)


def _with_restraint(problem: TickProblem, restraint: float) -> TickProblem:
    return problem._replace(criterion=Restrained(problem.criterion, restraint))


def _length(d: Array) -> float:
    return sqrt(d.dot(d))
