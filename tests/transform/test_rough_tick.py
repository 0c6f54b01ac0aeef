"""Ticks of a dry run: those of a run but for the last digits, each step a minimum by another solver."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from irlx.transform.clearance import SideRows
from irlx.transform.criteria.criterion import Criterion
from irlx.transform.criteria.least_motion import LeastMotion
from irlx.transform.criteria.posture import Posture
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.rough_tick import RoughTickSolver, _Step
from irlx.transform.tick import TickSolution, TickSolver, TickStatus
from irlx.transform.tick_problem import TickProblem
from long_run import first

pytestmark = pytest.mark.req("TRF-02")

ON_POSE = 5e-9
"""What a tick may leave of its pose (m or rad), per metre of reach."""

OFF_THE_BEST = 2e-4
"""How far a joint may be from the best posture (rad or m)."""


class Whole(Criterion):
    """1/2 (S - w)' H (S - w) with a full matrix."""

    name = "whole"

    def __init__(self, hessian: np.ndarray, wanted: np.ndarray) -> None:
        self._hessian, self._wanted = hessian, wanted

    def value(self, q, step):
        return 0.5 * (step - self._wanted) @ self._hessian @ (step - self._wanted)

    def gradient(self, q, step):
        return self._hessian @ (step - self._wanted)

    def hessian(self):
        return self._hessian


def drawn_tick(arm, rng: np.random.Generator) -> TickProblem:
    """A tick of about a row of a dry run; bounds from wide to tight, zeros and residues mixed in."""
    way = rng.uniform(-0.05, 0.05, arm.n) * rng.choice([0.0, 1e-16, 1.0], arm.n, p=[0.1, 0.1, 0.8])
    half = 0.06 * rng.choice([0.2, 0.5, 1.0, 1e3], arm.n, p=[0.15, 0.15, 0.3, 0.4])
    bounds = arm.bounds(half)
    free = rng.random(arm.n) > (0.1 if arm.n > 8 else 0.0)
    way = np.clip(np.where(free, way, 0.0), 0.9 * bounds.lower, 0.9 * bounds.upper)
    wanted = rng.uniform(-0.1, 0.1, arm.n)
    root = rng.normal(size=(arm.n, arm.n))
    criteria = (
        LeastMotion(arm.weights),
        Posture(arm.weights, arm.q + wanted),
        Whole(np.diag(arm.weights) + root @ root.T, wanted),
    )
    return TickProblem(arm.pose(arm.q + way), arm.q, bounds, criteria[rng.integers(3)], free)


def left_of_pose(arm, q: np.ndarray, target) -> float:
    """What is missing of a pose (m or rad), by SciPy."""
    rotation, position = arm.kinematics.tool_pose(q)
    turn = Rotation.from_matrix(rotation.T @ target.rotation).magnitude()
    return max(float(np.max(np.abs(target.translation - position))), float(turn))


@pytest.mark.parametrize("seed", first(2, range(6)))
def test_drawn_ticks_are_those_of_a_run_but_for_the_last_digits(arm, seed: int) -> None:
    """One solver for all of them in turn: what the tick before held must decide nothing."""
    print("seed", seed)
    rng = np.random.default_rng(seed)
    rough = RoughTickSolver(arm.kinematics, ProxQpSolver())
    exact = TickSolver(arm.kinematics, ProxQpSolver())
    solved = at_once = bounded = 0
    for _ in range(20):
        problem = drawn_tick(arm, rng)
        seed_step = rng.uniform(-0.05, 0.05, arm.n) * rng.choice([0.0, 1.0])
        best = exact.solve(problem, thorough=False)
        if not best.solved:
            continue
        found = rough.solve(problem, seed_step)
        assert found.solved
        assert left_of_pose(arm, found.q, problem.target) < ON_POSE * arm.size
        step = found.q - problem.q
        assert np.all(step >= problem.bounds.lower - 1e-15)
        assert np.all(step <= problem.bounds.upper + 1e-15)
        assert np.array_equal(found.q[~problem.free], problem.q[~problem.free])
        assert np.max(np.abs(found.q - best.q)) < OFF_THE_BEST
        solved += 1
        at_once += isinstance(rough.at_once(problem, seed_step), TickSolution)
        bounded += bool(np.any(best.active))
    print(solved, at_once, bounded, "statuses")
    assert at_once >= 0.7 * solved >= 3.0
    assert bounded >= 1


def step_of(seed: int, making, n: int):
    """A drawn Newton step, with two inequalities: as arguments of `_Step`, and those."""
    problem, rng = making.random_step_problem(seed, n), np.random.default_rng([seed, n, 1])
    pull = -problem.gradient / problem.hessian
    matrix = rng.normal(size=(2, n))
    sides = SideRows(matrix, matrix @ np.clip(pull, problem.lower, problem.upper) - rng.choice([0.0, 0.1], 2))
    hessian = problem.hessian
    if seed % 3 == 0:
        root = rng.normal(size=(n, n))
        hessian = np.diag(hessian) + root @ root.T
    free = np.ones(n, dtype=bool)
    arguments = problem.jacobian, problem.twist, pull, hessian, problem.lower, problem.upper, free
    return arguments, sides


@pytest.mark.parametrize("n", [7, 11])
@pytest.mark.parametrize("seed", range(12))
def test_a_step_is_the_minimum_by_another_solver(making, seed: int, n: int) -> None:
    """From any guess of what holds; SLSQP from the step itself finds nothing less within the bounds."""
    print("seed", seed, "n", n)
    (jacobian, twist, pull, hessian, low, up, free), sides = step_of(seed, making, n)
    rng = np.random.default_rng([seed, 2])
    guess = rng.choice([-1, 0, 0, 0, 1], n).astype(np.int8)
    step = _Step(jacobian, twist, pull, hessian, low, up, free)
    step.keep(sides, np.array([3, 8]), frozenset({8} if seed % 2 else ()))
    d = step.solved(guess)
    whole = np.diag(hessian) if hessian.ndim == 1 else hessian

    def cost(x):
        return 0.5 * (x - pull) @ whole @ (x - pull)

    constraints = [
        {"type": "eq", "fun": lambda x: jacobian @ x - twist, "jac": lambda x: jacobian},
        {"type": "ineq", "fun": lambda x: sides.matrix @ x - sides.lower, "jac": lambda x: sides.matrix},
    ]
    # Fixed joints have no room that SLSQP could take a gradient in.
    limits = list(zip(low, np.maximum(up, low + 1e-12), strict=True))
    begin = np.clip(pull if d is None else d, low, up)
    truth = minimize(
        cost,
        begin,
        jac=lambda x: whole @ (x - pull),
        bounds=limits,
        constraints=constraints,
        method="SLSQP",
        options={"maxiter": 300, "ftol": 1e-14},
    )
    feasible = truth.success and np.max(np.abs(jacobian @ truth.x - twist)) < 1e-7
    if d is None:
        # Bounds that meet in a point may go round in circles here; then the tick is solved with care.
        return
    assert np.max(np.abs(jacobian @ d - twist)) < 1e-8
    assert np.all(d >= low - 1e-9)
    assert np.all(d <= up + 1e-9)
    assert np.all(sides.matrix @ d >= sides.lower - 1e-8)
    if feasible:
        assert cost(d) <= cost(truth.x) + 1e-6 * (1.0 + abs(cost(truth.x)))


def test_steps_are_found_at_once_as_a_rule(making) -> None:
    """Were the exchange of bounds to fail as a rule, ticks would be solved with care all the time."""
    found = 0
    for seed in range(40):
        arguments, _ = step_of(seed, making, 11)
        found += _Step(*arguments).solved(np.zeros(11, dtype=np.int8)) is not None
    assert found >= 25


def test_what_cannot_be_done_is_said_as_in_a_run(arm7) -> None:
    """No step keeps bounds of nothing; thorough and not."""
    rotation, position = arm7.kinematics.tool_pose(arm7.q)
    target = arm7.kinematics.target(rotation, position + np.array([0.02, 0.0, 0.0]))
    free = np.ones(7, dtype=bool)
    problem = TickProblem(target, arm7.q, arm7.bounds(1e-4), LeastMotion(arm7.weights), free)
    rough = RoughTickSolver(arm7.kinematics, ProxQpSolver())
    exact = TickSolver(arm7.kinematics, ProxQpSolver())
    for thorough in (False, True):
        assert rough.solve(problem, None, thorough).status is exact.solve(problem, None, thorough).status
    assert rough.at_once(problem, np.zeros(7)) is TickStatus.NO_STEP


def test_bounds_that_contradict_each_other_are_left_to_the_exact_solver(arm7) -> None:
    bounds = arm7.bounds(0.05)
    bounds.lower[2] = bounds.upper[2] + 1e-3
    free = np.ones(7, dtype=bool)
    problem = TickProblem(arm7.pose(arm7.q), arm7.q, bounds, LeastMotion(arm7.weights), free)
    rough = RoughTickSolver(arm7.kinematics, ProxQpSolver())
    assert rough.at_once(problem, np.zeros(7)) is TickStatus.BOUNDS_CONFLICT
    assert rough.solve(problem).status is TickStatus.BOUNDS_CONFLICT
