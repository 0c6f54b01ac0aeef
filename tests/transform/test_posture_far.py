"""Postures far from the reference: the iteration settles, and the nearest posture is found."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.motion.trapezoid import Trapezoid
from irlx.pacing.governed_return import governed_reference, way_to_best
from irlx.pacing.slowdown.model import Model
from irlx.robot.limits import JointLimits
from irlx.transform.criteria.posture import Posture
from irlx.transform.fibre import Fibre
from irlx.transform.posture_search import closest, nearest_approach, nearest_posture
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.tick import TickSolver
from irlx.transform.tick_problem import TickProblem


def limits_of(arm) -> JointLimits:
    return JointLimits.unlimited(arm.n).with_pair("position", arm.lower, arm.upper)


def projected(arm, q: np.ndarray, gradient: np.ndarray) -> float:
    """Length of the gradient's part along the null space of the Jacobian."""
    _, jacobian = arm.kinematics.difference(q, arm.pose(q))
    _, _, basis = np.linalg.svd(jacobian)
    return float(np.linalg.norm(basis[6:] @ gradient))


SAFE_CURVATURE = 0.4
"""Least curvature of the distance along the fibre, 1 on a straight one, from which a return is governed."""


def tick_towards(arm, q: np.ndarray, reference: np.ndarray, max_iterations: int = 30):
    """One tick at the tool pose of arm.q from q, drawn to a reference without bounds."""
    solver = TickSolver(arm.kinematics, ProxQpSolver(), max_iterations=max_iterations)
    bounds = arm.bounds(np.inf)
    bounds.lower[:], bounds.upper[:] = -np.inf, np.inf
    free, criterion = np.ones(arm.n, dtype=bool), Posture(arm.weights, reference)
    return solver.solve(TickProblem(arm.pose(arm.q), q, bounds, criterion, free))


@pytest.mark.req("TRF-05")
@pytest.mark.parametrize("away", [1.0, 2.0])
def test_iteration_towards_a_far_reference_settles(arm, away: float) -> None:
    """At a fixed pose: the tool stays, phi falls, and the tick ends at a rest point in most draws."""
    settled = 0
    for seed in range(12):
        rng = np.random.default_rng(seed)
        reference = arm.q + rng.uniform(-1.0, 1.0, arm.n) * away
        criterion = Posture(arm.weights, reference)
        solution = tick_towards(arm, arm.q, reference, 200)
        if not solution.solved:
            continue
        settled += 1
        _, position = arm.kinematics.tool_pose(solution.q)
        assert np.linalg.norm(position - arm.pose(arm.q).translation) < 1e-10, f"seed {seed}"
        step = solution.q - arm.q
        assert criterion.value(arm.q, step) <= criterion.value(arm.q, np.zeros(arm.n)), f"seed {seed}"
        gradient = criterion.gradient(arm.q, step)
        assert projected(arm, solution.q, gradient) < 1e-6, f"seed {seed}"
        assert solution.iterations < 100, f"seed {seed}"
    assert settled >= 11


def governed_walk(arm, goal: np.ndarray, ticks: int = 200) -> tuple[float, list[np.ndarray], float]:
    """Curvature of the distance at the start, postures of ticks at a fixed pose, s of a tick.

    The reference goes the governed way under joint speeds of 1 rad/s, over a law of 2 s.
    """
    free, unlimited = np.ones(arm.n, dtype=bool), JointLimits.unlimited(arm.n)
    way = way_to_best(Model(arm.kinematics, unlimited, arm.weights, free), arm.q, goal, ProxQpSolver())
    law, speed = Trapezoid.fastest(1.0, 1.0, 1.0), np.ones(arm.n)
    reference = governed_reference(goal, way, law, unlimited.with_pair("speed", -speed, speed))
    wide = np.full(arm.n, np.inf)
    fibre = Fibre(arm.kinematics, arm.pose(arm.q), reference(0.0), arm.weights, (-wide, wide), free)
    curvature = float(np.linalg.eigvalsh(fibre.curvature(arm.q, fibre.tangent(arm.q)))[0])
    rows = [arm.q]
    for s in law.evaluate(np.linspace(0.0, law.duration, ticks + 1)[1:])[0]:
        solution = tick_towards(arm, rows[-1], reference(float(s)))
        if not solution.solved:
            break
        rows.append(solution.q)
    return curvature, rows, law.duration / ticks


def assert_governed(arm, goal: np.ndarray, rows: list[np.ndarray], dt: float, told: str) -> None:
    """Every tick solved, changes of speed below the governed rate of 1 rad/s in 0.2 s, distance falling."""
    assert len(rows) == 201, told
    speeds = np.diff(np.array([rows[0], *rows]), axis=0) / dt
    assert np.max(np.abs(np.diff(speeds, axis=0))) / dt <= 1.0 / 0.2, told
    away = [float(arm.weights @ (row - goal) ** 2) for row in rows]
    assert np.all(np.diff(away) <= 1e-9 * away[0]), told


@pytest.mark.req("TRF-05")
@pytest.mark.req("TRF-14")
@pytest.mark.parametrize("away", [1.0, 2.0, 3.0])
def test_a_governed_reference_is_never_far(arm, away: float) -> None:
    """What a tick is drawn to is a step away however far the goal: it settles, and no joint jumps.

    Provided that the distance bends upwards along the fibre by `SAFE_CURVATURE` or more, as it does for
    nearly all goals drawn here; see the test behind this one.
    """
    governed = 0
    for seed in range(12):
        goal = arm.q + np.random.default_rng(seed).uniform(-1.0, 1.0, arm.n) * away
        curvature, rows, dt = governed_walk(arm, goal)
        if curvature >= SAFE_CURVATURE:
            assert_governed(arm, goal, rows, dt, f"seed {seed}, curvature {curvature:.3g}")
            governed += 1
    assert governed >= 6


@pytest.mark.req("TRF-05")
@pytest.mark.xfail(
    strict=True, reason="where the distance hardly bends along the fibre, or downwards, it jumps"
)
def test_a_goal_on_whose_slope_the_fibre_bends_away(koch11) -> None:
    """2 rad off the pose the goal's pull against the pose outweighs W: the best posture is no minimum."""
    goal = koch11.q + np.random.default_rng(4).uniform(-1.0, 1.0, 11) * 2.0
    curvature, rows, dt = governed_walk(koch11, goal)
    assert curvature < 0.0
    assert_governed(koch11, goal, rows, dt, f"curvature {curvature:.3g}")


@pytest.mark.req("TRF-05")
@pytest.mark.parametrize(
    ("name", "seed"),
    [
        ("arm7", 0),
        ("arm7", 1),
        ("koch11", 1),
        ("koch11", 2),
        ("koch11", 0),
    ],
)
def test_a_walk_towards_a_far_reference_does_not_chatter(request, name: str, seed: int) -> None:
    """Ticks at a fixed pose under a speed bound: the distance falls every tick, then all is still."""
    arm, rng = request.getfixturevalue(name), np.random.default_rng(seed)
    criterion = Posture(arm.weights, arm.q + rng.uniform(-1.0, 1.0, arm.n))
    target, q = arm.pose(arm.q), arm.q
    values = [criterion.value(q, np.zeros(arm.n))]
    for _ in range(60):
        solution = arm.solve(target, criterion, arm.bounds(0.05, q), q=q)
        assert solution.solved
        moved, q = float(np.max(np.abs(solution.q - q))), solution.q
        values.append(criterion.value(q, np.zeros(arm.n)))
    assert np.all(np.diff(values) <= 1e-12)
    assert moved < 1e-8


@pytest.mark.req("MOT-05")
@pytest.mark.parametrize("seed", range(1))
def test_nearest_posture_reaches_the_pose_and_beats_random_starts(arm7, seed: int) -> None:
    rng = np.random.default_rng(seed)
    goal = arm7.q + rng.uniform(-0.8, 0.8, 7)
    rotation, position = arm7.kinematics.tool_pose(goal)
    free = np.ones(7, dtype=bool)
    args = (arm7.kinematics, ProxQpSolver(), rotation, position, arm7.q, arm7.weights, limits_of(arm7), free)
    search = nearest_posture(*args)
    found = search.q
    assert found is not None
    assert search.nearest.distance < 1e-6
    reached = arm7.kinematics.tool_pose(found)
    np.testing.assert_allclose(reached[0], rotation, atol=1e-9)
    np.testing.assert_allclose(reached[1], position, atol=1e-9)
    assert np.all((found >= arm7.lower) & (found <= arm7.upper))
    assert arm7.weights @ (found - arm7.q) ** 2 <= arm7.weights @ (goal - arm7.q) ** 2 + 1e-9
    np.testing.assert_array_equal(found, nearest_posture(*args).q)


@pytest.mark.req("TRF-12")
def test_nearest_posture_keeps_frozen_joints(koch11) -> None:
    free = np.ones(11, dtype=bool)
    free[[1, 2]] = False
    goal = koch11.q + np.where(free, 0.1, 0.0)
    pose = koch11.kinematics.tool_pose(goal)
    args = (koch11.q, koch11.weights, limits_of(koch11), free)
    found = nearest_posture(koch11.kinematics, ProxQpSolver(), *pose, *args).q
    assert found is not None
    assert found[~free].tobytes() == koch11.q[~free].tobytes()


def nearest(arm, rotation: np.ndarray, position: np.ndarray):
    free = np.ones(arm.n, dtype=bool)
    found = nearest_approach(arm.kinematics, rotation, position, arm.q, limits_of(arm), free)
    return closest(found, arm.kinematics.description.reach)


@pytest.mark.req("MOT-22")
def test_nearest_approach_to_a_pose_beyond_the_stretched_arm(arm7) -> None:
    """Straight up, 0.3 m beyond: the stretched arm comes that near."""
    rotation, position = arm7.kinematics.tool_pose(np.zeros(7))
    far = position + np.array([0.0, 0.0, 0.3])
    found = nearest(arm7, rotation, far)
    assert found.distance == pytest.approx(0.3, abs=1e-3)
    assert found.angle < 1e-2
    assert np.all((found.q >= arm7.lower) & (found.q <= arm7.upper))
    reached = arm7.kinematics.tool_pose(found.q)[1]
    # The screw's translation is the distance of the tool points where nothing turns.
    assert np.linalg.norm(reached - far) == pytest.approx(found.distance, rel=1e-3)


@pytest.mark.req("MOT-22")
def test_nearest_approach_to_a_pose_within_reach_leaves_nothing(arm) -> None:
    found = nearest(arm, *arm.kinematics.tool_pose(np.clip(arm.q + 0.2, arm.lower, arm.upper)))
    assert found.distance < 1e-6
    assert found.angle < 1e-6


@pytest.mark.req("MOT-22")
def test_nothing_is_found_for_a_pose_out_of_reach(arm7) -> None:
    rotation, position = arm7.kinematics.tool_pose(np.zeros(7))
    far = position + np.array([0.0, 0.0, 0.01])
    free = np.ones(7, dtype=bool)
    args = (arm7.q, arm7.weights, limits_of(arm7), free)
    search = nearest_posture(arm7.kinematics, ProxQpSolver(), rotation, far, *args)
    assert search.q is None
    assert search.nearest.distance == pytest.approx(0.01, rel=0.05)
