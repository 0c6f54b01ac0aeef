"""What a tick costs, counted in Newton steps and kinematics; and that shortcuts give the same answers."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.pacing.demand import Demand
from irlx.pacing.walk import walk
from irlx.robot.limits import JointLimits
from irlx.transform.compact import bounded_step, free_step, within
from irlx.transform.criteria.least_motion import LeastMotion
from irlx.transform.criteria.posture import Posture
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.qp.solver import QpSolution
from irlx.transform.step_bounds import StepLimiter
from irlx.transform.tick import TickSolver
from irlx.transform.tick_problem import TickProblem
from long_run import first


class Counted:
    """Kinematics that counts its calls."""

    def __init__(self, kinematics) -> None:
        self._kinematics, self.calls = kinematics, 0

    def __getattr__(self, name: str):
        return getattr(self._kinematics, name)

    def difference(self, q, target):
        self.calls += 1
        return self._kinematics.difference(q, target)


def smooth_demands(arm, dt: float, ticks: int) -> list[Demand]:
    """A tenth of a reach away from the start and nearly back, a sine from rest."""
    rotation, position = arm.kinematics.tool_pose(arm.q)
    way = np.array([-0.05, 0.03, -0.04]) * arm.kinematics.description.reach
    s = 0.5 * (1.0 - np.cos(np.pi * dt * np.arange(1, ticks + 1)))
    return [Demand(k, s[k], position + s[k] * way, rotation, np.zeros(6)) for k in range(ticks)]


CRITERIA = {
    "least motion": (lambda arm: LeastMotion(arm.weights), 1.15),
    "posture": (lambda arm: Posture(arm.weights, arm.q), 2.5),
}


@pytest.mark.parametrize(("make", "most"), CRITERIA.values(), ids=CRITERIA.keys())
def test_a_smooth_walk_takes_few_newton_steps_a_tick(arm, making, make, most: float) -> None:
    """One step a tick of 1 ms, more for the posture criterion; one evaluation of the robot each; no QP."""
    counted, n = Counted(arm.kinematics), arm.n
    criterion = make(arm)
    solver = TickSolver(counted, qp=None)
    limiter = StepLimiter(making.limits(n, np.inf, 50.0, 500.0), 0.001)
    walked = walk(
        solver, limiter, lambda _: criterion, np.ones(n, bool), arm.q, smooth_demands(arm, 0.001, 600)
    )
    assert walked.halt is None
    assert walked.iterations <= most * 600
    assert counted.calls == walked.iterations


@pytest.mark.req("TRF-10")
@pytest.mark.parametrize("make", [make for make, _ in CRITERIA.values()], ids=CRITERIA.keys())
def test_the_seed_decides_nothing(arm, make) -> None:
    """Seeds as good as those of a walk, and ones far off: the answer of a tick is the same to 1e-12."""
    rng = np.random.default_rng(5)
    solver, free = TickSolver(arm.kinematics, ProxQpSolver()), np.ones(arm.n, bool)
    criterion, bounds = make(arm), arm.bounds(0.5)
    for _ in range(20):
        target = arm.pose(arm.q + rng.uniform(-1e-2, 1e-2, arm.n))
        problem = TickProblem(target, arm.q, bounds, criterion, free)
        unseeded = solver.solve(problem)
        assert unseeded.solved
        for size in (0.0, 1e-10, 1e-6, 1e-2):
            seed = unseeded.q - arm.q + size * rng.uniform(-1.0, 1.0, arm.n)
            np.testing.assert_allclose(solver.solve(problem, seed).q, unseeded.q, rtol=0, atol=1e-12)


@pytest.mark.parametrize("dt", first(1, [0.00025, 0.004, 0.001]))
@pytest.mark.parametrize("make", [make for make, _ in CRITERIA.values()], ids=CRITERIA.keys())
def test_second_differences_carry_no_noise_of_the_iteration(
    arm, making, make, dt: float, monkeypatch
) -> None:
    """Against ticks iterated ten times within tolerance: 1e-6 rad/s2 at 1 ms, where rounding adds 1e-9."""
    n, criterion = arm.n, make(arm)
    limiter, asked = StepLimiter(making.limits(n, np.inf, 50.0, 500.0), dt), smooth_demands(arm, dt, 300)

    def rows() -> np.ndarray:
        solver = TickSolver(arm.kinematics, qp=None, max_iterations=60)
        return walk(solver, limiter, lambda _: criterion, np.ones(n, bool), arm.q, asked).q

    quick = rows()
    monkeypatch.setattr("irlx.transform.settling.SETTLED_ERROR", -1.0)
    monkeypatch.setattr("irlx.transform.settling.ROUNDING_STEP", -1.0)
    monkeypatch.setattr("irlx.transform.settling.MOST_CALM_STEPS", 10)
    noise = np.max(np.abs(np.diff(quick - rows(), 2, axis=0))) / dt**2
    assert noise <= max(1e-6, 1e-6 * (0.001 / dt) ** 2)


@pytest.mark.req("TRF-12")
def test_frozen_joints_keep_their_bits_without_a_qp(arm, making) -> None:
    free = np.ones(arm.n, bool)
    free[2] = False
    criterion = LeastMotion(arm.weights)
    limiter = StepLimiter(making.limits(arm.n, np.inf, 50.0, 500.0), 0.001)
    solver = TickSolver(arm.kinematics, qp=None)
    walked = walk(solver, limiter, lambda _: criterion, free, arm.q, smooth_demands(arm, 0.001, 100))
    assert walked.halt is None
    assert np.all(walked.q[:, 2] == arm.q[2])


@pytest.mark.req("TRF-02")
@pytest.mark.req("TRF-03")
@pytest.mark.parametrize("dt", first(2, [0.00025, 0.05, 0.001, 0.01]))
def test_quick_bounds_are_those_with_sources(dt: float) -> None:
    """Bit for bit, with every mixture of known, unknown and zero limits, near to and far from limits."""
    rng = np.random.default_rng(3)
    for _ in range(400):
        n = 6
        position = rng.choice([0.01, 1.0, 3.0, np.inf], n)
        speeds = rng.choice([0.0, 0.5, 3.0, np.inf], (2, n))
        accelerations = rng.choice([0.0, 2.0, 40.0, np.inf], (2, n), p=[0.1, 0.4, 0.4, 0.1])
        limits = JointLimits(-position, position, -speeds[0], speeds[1], -accelerations[0], accelerations[1])
        limiter = StepLimiter(limits, dt)
        q = np.clip(rng.normal(size=n) * rng.choice([0.1, 1.0]), -position, position)
        speed = rng.uniform(-1.0, 1.0, n) * np.minimum(np.min(speeds, axis=0), 3.0)
        quick, full = limiter.bounds(q, speed), limiter.bounds_with_sources(q, speed)
        assert np.array_equal(quick.lower, full.lower)
        assert np.array_equal(quick.upper, full.upper)
        assert np.array_equal(quick.lower_source, full.lower_source)
        assert np.array_equal(quick.upper_source, full.upper_source)


class Careless:
    """A QP solver that claims to have met bounds that it breaks."""

    def solve(self, rows, lower, upper) -> QpSolution:
        right = ProxQpSolver().solve(rows, lower, upper)
        return QpSolution(None if right.z is None else right.z + 1e-6, right.active)


def test_a_qp_answer_outside_its_bounds_is_an_error_not_a_clip(making) -> None:
    for seed in range(200):
        problem = making.random_step_problem(seed, 11)
        d_free = free_step(problem)
        if within(d_free, problem.lower, problem.upper):
            continue
        if bounded_step(problem, d_free, ProxQpSolver()) is not None:
            break
    with pytest.raises(ArithmeticError, match="outside its bounds"):
        bounded_step(problem, d_free, Careless())
