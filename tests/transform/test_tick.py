"""One tick of the inverse transform on a 7-axis arm and koch11, judged by its optimality conditions."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from irlx.transform.criteria.least_motion import LeastMotion
from irlx.transform.criteria.posture import Posture
from irlx.transform.tick import TickStatus
from irlx.transform.tick_problem import TickProblem, build_tick
from long_run import first


def random_target(arm, rng: np.random.Generator, size: float):
    """A pose near the arm's own: moved by up to `size` m and turned by up to `size` rad."""
    rotation, position = arm.kinematics.tool_pose(arm.q)
    reach = arm.kinematics.description.reach
    way = rng.uniform(-1, 1, 3) * size * min(1.0, reach) * rng.choice([0.0, 1e-16, 1.0], 3, p=[0.2, 0.1, 0.7])
    turn = Rotation.from_rotvec(rng.uniform(-1, 1, 3) * size * rng.choice([0.0, 1.0]))
    return arm.kinematics.target(rotation @ turn.as_matrix(), position + way)


def residual(arm, q: np.ndarray, target) -> np.ndarray:
    """Position (m) and rotation vector (rad) still missing, by SciPy."""
    rotation, position = arm.kinematics.tool_pose(q)
    turn = Rotation.from_matrix(rotation.T @ target.rotation).as_rotvec()
    return np.concatenate([target.translation - position, turn])


def assert_optimal(arm, solution, target, criterion, bounds, where: str, free=None) -> None:
    """Karush, Kuhn, Tucker: gradient = J'k + multipliers of active bounds, which push inwards."""
    free = np.ones(arm.n, dtype=bool) if free is None else free
    _, jacobian = arm.kinematics.difference(solution.q, target)
    step = solution.q - arm.q
    inside = free & (step > bounds.lower + 1e-10) & (step < bounds.upper - 1e-10)
    gradient = criterion.gradient(arm.q, step)
    scale = max(1.0, float(np.max(np.abs(gradient))))
    # Multipliers of the path from the joints that are free to move, then of the bounds from the rest.
    k, *_ = np.linalg.lstsq(jacobian[:, inside].T, gradient[inside], rcond=None)
    left = gradient - jacobian.T @ k
    assert np.max(np.abs(left[inside]), initial=0.0) < 1e-7 * scale, where
    if np.linalg.matrix_rank(jacobian[:, inside]) < 6:
        return
    at_upper, at_lower = free & (step >= bounds.upper - 1e-10), free & (step <= bounds.lower + 1e-10)
    assert np.all(left[at_upper & ~at_lower] <= 1e-7 * scale), where
    assert np.all(left[at_lower & ~at_upper] >= -1e-7 * scale), where


EXACT = 1e-12
"""Pose error left by a solved tick, per metre of the robot's reach where that is more than one."""

CRITERIA = {
    "least motion": lambda arm, rng: LeastMotion(arm.weights),
    "posture": lambda arm, rng: Posture(arm.weights, arm.q + rng.uniform(-0.3, 0.3, arm.n)),
}


@pytest.mark.req("TRF-01")
@pytest.mark.parametrize("size", first(2, [1e-4, 0.1, 0.01]))
@pytest.mark.parametrize("make", CRITERIA.values(), ids=CRITERIA.keys())
def test_solved_ticks_meet_pose_bounds_and_optimality(arm, make, size: float) -> None:
    """Random targets with bounds from far to tight; the ones that are solved are solved exactly."""
    solved = bound = 0
    for seed in range(30):
        rng = np.random.default_rng(seed)
        target, criterion = random_target(arm, rng, size), make(arm, rng)
        half = size * rng.choice([1.0, 10.0]) * rng.uniform(0.2, 1.0, arm.n)
        if seed % 5 == 0:
            half[rng.integers(arm.n)] = 0.0
        if seed % 2:
            # One joint may go a little less far than it would without bounds.
            free_way = np.abs(arm.solve(target, criterion, arm.bounds(np.inf)).q - arm.q)
            half = np.full(arm.n, 100.0)
            joint = rng.integers(arm.n)
            half[joint] = 0.95 * free_way[joint]
        bounds = arm.bounds(half)
        solution = arm.solve(target, criterion, bounds)
        where = f"seed {seed}, size {size}"
        if not solution.solved:
            continue
        solved += 1
        bound += bool(np.any(solution.active))
        assert np.max(np.abs(residual(arm, solution.q, target))) < EXACT * arm.size, where
        step = solution.q - arm.q
        assert np.all(step <= bounds.upper + 2.3e-16 * 3), where
        assert np.all(step >= bounds.lower - 2.3e-16 * 3), where
        assert_optimal(arm, solution, target, criterion, bounds, where)
    assert solved >= 8
    assert bound >= 4


@pytest.mark.req("TRF-01")
@pytest.mark.parametrize("seed", first(3, [1, 2, 3, 0, 4, 5]))
def test_posture_equals_that_of_a_general_solver(arm, seed: int) -> None:
    """SLSQP on the nonlinear problem itself: min phi, pose met, step within bounds."""
    rng = np.random.default_rng(seed)
    target = random_target(arm, rng, 0.02)
    criterion = Posture(arm.weights, arm.q + rng.uniform(-0.1, 0.1, arm.n))
    bounds = arm.bounds(rng.uniform(0.08, 0.2, arm.n))
    solution = arm.solve(target, criterion, bounds)
    assert solution.solved
    found = minimize(
        lambda d: criterion.value(arm.q, d),
        np.zeros(arm.n),
        jac=lambda d: criterion.gradient(arm.q, d),
        bounds=list(zip(bounds.lower, bounds.upper, strict=True)),
        constraints={"type": "eq", "fun": lambda d: residual(arm, arm.q + d, target)},
        method="SLSQP",
        options={"ftol": 1e-15, "maxiter": 300},
    )
    assert found.success, found.message
    np.testing.assert_allclose(solution.q, arm.q + found.x, atol=2e-6, err_msg=f"seed {seed}")


@pytest.mark.req("TRF-12")
@pytest.mark.parametrize("make", CRITERIA.values(), ids=CRITERIA.keys())
def test_frozen_joints_keep_every_bit(koch11, make) -> None:
    for seed in range(20):
        rng = np.random.default_rng(seed)
        target, criterion = random_target(koch11, rng, 0.01), make(koch11, rng)
        free = np.ones(11, dtype=bool)
        free[rng.choice(11, int(rng.integers(1, 5)), replace=False)] = False
        bounds = koch11.bounds(0.2)
        solution = koch11.solve(target, criterion, bounds, free=free)
        assert solution.q[~free].tobytes() == koch11.q[~free].tobytes(), f"seed {seed}"
        assert not np.any(solution.active[~free])
        if solution.solved:
            _, jacobian = koch11.kinematics.difference(solution.q, target)
            # Frozen joints may leave a direction that no joint serves; the last step cannot mend it there.
            served = np.linalg.svd(jacobian[:, free], compute_uv=False)[-1] > 1e-6
            allowed = EXACT * koch11.size if served else 1e-7
            assert np.max(np.abs(residual(koch11, solution.q, target))) < allowed, f"seed {seed}"


@pytest.mark.req("TRF-02")
def test_bound_exactly_at_the_state_is_never_passed(arm) -> None:
    """Every joint in turn stands on its upper or lower limit; the path is drawn past it."""
    for joint in range(arm.n):
        for side in (1.0, -1.0):
            q = arm.q
            low, up = np.full(arm.n, -0.05), np.full(arm.n, 0.05)
            (up if side > 0 else low)[joint] = 0.0
            bounds = arm.bounds(1.0)
            bounds.lower[:], bounds.upper[:] = low, up
            wish = np.full(arm.n, 0.01)
            wish[joint] = side * 0.02
            solution = arm.solve(arm.pose(q + wish), Posture(arm.weights, q + wish), bounds)
            assert side * (solution.q[joint] - q[joint]) <= 0.0, f"joint {joint}, side {side}"
            if solution.solved:
                assert solution.q[joint] == q[joint]


@pytest.mark.req("TRF-04")
@pytest.mark.parametrize("far", [0.5, 5.0, 1e3])
def test_pose_out_of_reach_is_not_solved_and_raises_nothing(arm, far: float) -> None:
    rotation, position = arm.kinematics.tool_pose(arm.q)
    reach = arm.kinematics.description.reach
    target = arm.kinematics.target(rotation, position / np.linalg.norm(position) * (reach + far))
    for criterion in (LeastMotion(arm.weights), Posture(arm.weights, arm.q)):
        solution = arm.solve(target, criterion, arm.bounds(np.inf))
        assert solution.status in (TickStatus.NO_STEP, TickStatus.NOT_CONVERGED)
        assert np.all(np.isfinite(solution.q))
        assert np.all(solution.q <= arm.upper + 1e-15)
        assert np.all(solution.q >= arm.lower - 1e-15)
        assert np.linalg.norm(solution.twist[:3]) > 0.1


@pytest.mark.req("TRF-04")
@pytest.mark.parametrize("along", [0, 1, 2])
@pytest.mark.parametrize("way", [-1e-2, -1e-5, 0.0, 1e-9, 1e-3])
def test_stretched_arm_emits_no_pose_error(arm7, along: int, way: float) -> None:
    """From the singular posture a tick is solved on the path or not at all."""
    q = np.zeros(7)
    rotation, position = arm7.kinematics.tool_pose(q)
    position[along] += way
    target = arm7.kinematics.target(rotation, position)
    solution = arm7.solve(target, LeastMotion(arm7.weights), arm7.bounds(0.5, q), q=q)
    assert np.all(np.isfinite(solution.q))
    if solution.solved:
        assert np.max(np.abs(residual(arm7, solution.q, target))) < 1e-7
    else:
        assert way != 0.0


@pytest.mark.req("TRF-02")
def test_contradicting_bounds_end_the_tick_at_once(arm7) -> None:
    bounds = arm7.bounds(0.1)
    bounds.lower[3], bounds.upper[3] = 0.02, 0.01
    solution = arm7.solve(arm7.pose(arm7.q), LeastMotion(arm7.weights), bounds)
    assert solution.status is TickStatus.BOUNDS_CONFLICT
    assert solution.iterations == 0
    np.testing.assert_array_equal(solution.q, arm7.q)


def walked(arm, criterion, ticks: int) -> np.ndarray:
    """End posture of a 0.2 m line and a turn of 0.3 rad in so many ticks."""
    rotation, position = arm.kinematics.tool_pose(arm.q)
    q = arm.q
    for share in np.arange(1, ticks + 1) / ticks:
        turn = Rotation.from_rotvec([0.0, 0.3 * share, 0.1 * share]).as_matrix()
        target = arm.kinematics.target(rotation @ turn, position + share * np.array([0.05, -0.15, 0.1]))
        solution = arm.solve(target, criterion, arm.bounds(np.inf, q), q=q)
        assert solution.solved
        q = solution.q
    return q


@pytest.mark.req("TRF-10")
def test_half_the_tick_halves_the_difference_of_postures(arm) -> None:
    """Least motion depends on the tick to first order: successive differences fall by about two."""
    ends = [walked(arm, LeastMotion(arm.weights), ticks) for ticks in (10, 20, 40, 80)]
    apart = [np.linalg.norm(b - a) for a, b in pairwise(ends)]
    for coarse, fine in pairwise(apart):
        assert 1.6 < coarse / fine < 2.6, apart


@pytest.mark.req("TRF-10")
def test_posture_criterion_does_not_depend_on_the_tick(arm) -> None:
    """Without active bounds the pose alone decides the posture."""
    criterion = Posture(arm.weights, arm.q)
    np.testing.assert_allclose(walked(arm, criterion, 10), walked(arm, criterion, 23), atol=1e-8)


@pytest.mark.req("TRF-10")
@pytest.mark.parametrize("make", CRITERIA.values(), ids=CRITERIA.keys())
def test_criterion_derivatives_equal_finite_differences(arm, make) -> None:
    rng = np.random.default_rng(4)
    criterion = make(arm, rng)
    step, h = rng.uniform(-0.5, 0.5, arm.n), 1e-6
    gradient = criterion.gradient(arm.q, step)
    for joint in range(arm.n):
        e = np.zeros(arm.n)
        e[joint] = h
        slope = (criterion.value(arm.q, step + e) - criterion.value(arm.q, step - e)) / (2 * h)
        assert gradient[joint] == pytest.approx(slope, abs=1e-7)
        bend = (criterion.gradient(arm.q, step + e) - criterion.gradient(arm.q, step - e)) / (2 * h)
        np.testing.assert_allclose(bend, np.diag(criterion.hessian())[joint], atol=1e-6)


def test_a_problem_begins_where_the_tick_does(arm) -> None:
    """Without a step so far it is that of no step; with one, bounds and gradient are those that are left."""
    bounds = arm.bounds(0.1)
    free, criterion = np.ones(arm.n, dtype=bool), LeastMotion(arm.weights)
    problem = TickProblem(arm.pose(arm.q + 0.01), arm.q, bounds, criterion, free)
    begun, same = build_tick(arm.kinematics, problem), build_tick(arm.kinematics, problem, np.zeros(arm.n))
    for name in ("jacobian", "twist", "gradient", "hessian", "lower", "upper"):
        np.testing.assert_array_equal(getattr(begun, name), getattr(same, name))
    step = np.full(arm.n, 0.004)
    further = build_tick(arm.kinematics, problem, step)
    np.testing.assert_array_equal(further.lower, bounds.lower - step)
    np.testing.assert_array_equal(further.upper, bounds.upper - step)
    np.testing.assert_array_equal(further.gradient, arm.weights * step)
