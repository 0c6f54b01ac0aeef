"""Postures far from the reference: the iteration settles, and the nearest posture is found."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.motion.trapezoid import Trapezoid
from irlx.pacing.governed_return import governed_reference, share_of_way
from irlx.pacing.return_way import ReturnWay, return_way
from irlx.pacing.slowdown.model import Model
from irlx.robot.limits import JointLimits
from irlx.transform.criteria.posture import Posture
from irlx.transform.fibre import Fibre
from irlx.transform.nearest import nearest_from, nearest_in_bounds
from irlx.transform.posture_search import closest, nearest_approach, nearest_posture
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.step_bounds import StepLimiter
from irlx.transform.tick import TickSolver
from irlx.transform.tick_problem import TickProblem
from long_run import first


def limits_of(arm) -> JointLimits:
    return JointLimits.unlimited(arm.n).with_pair("position", arm.lower, arm.upper)


def projected(arm, q: np.ndarray, gradient: np.ndarray) -> float:
    """Length of the gradient's part along the null space of the Jacobian."""
    _, jacobian = arm.kinematics.difference(q, arm.pose(q))
    _, _, basis = np.linalg.svd(jacobian)
    return float(np.linalg.norm(basis[6:] @ gradient))


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


RATE, GOVERNED = 1.0, 5.0
"""Joint speed of the governed walks, rad/s, and what stands for an unknown acceleration: that in 0.2 s."""

HARD = [("koch11", 2.0, 4), ("koch11", 3.0, 3), ("koch11", 3.0, 4), ("koch11", 3.0, 5), ("koch11", 3.0, 7)]
HARD += [("arm7", 3.0, 3)]
"""Robot, distance and seed of draws towards which a straight way jumped or did not settle."""

BY_DEFAULT = [(HARD[0], 5e-2), (HARD[1], 5e-2), (HARD[2], 5e-2), (HARD[5], 5e-2), (HARD[5], 1e-2)]
"""Draws whose ways are soon found, at the longest tick, that of the smaller robot at two."""


def by_default(hard: tuple, dt: float, acceleration: float) -> bool:
    """Without an acceleration limit one draw alone: nothing else bounds the ticks there."""
    return (hard, dt) in BY_DEFAULT and (np.isfinite(acceleration) or hard == HARD[2])


SEEDS = first(1, [range(2), range(2, 12)])


def goal_of(arm, away: float, seed: int) -> np.ndarray:
    return arm.q + np.random.default_rng(seed).uniform(-1.0, 1.0, arm.n) * away


WAYS: dict[tuple[int, bytes], ReturnWay] = {}
"""Ways that have been looked for, by number of joints and goal: a dozen tests go along the same few."""


def way_of(arm, goal: np.ndarray) -> ReturnWay:
    known = arm.n, goal.tobytes()
    if known not in WAYS:
        free = np.ones(arm.n, dtype=bool)
        model = Model(arm.kinematics, JointLimits.unlimited(arm.n), arm.weights, free)
        way = return_way(model, arm.q, goal, ProxQpSolver())
        assert way is not None
        WAYS[known] = way
    return WAYS[known]


def fibre_of(arm, goal: np.ndarray) -> Fibre:
    wide, free = np.full(arm.n, np.inf), np.ones(arm.n, dtype=bool)
    return Fibre(arm.kinematics, arm.pose(arm.q), goal, arm.weights, (-wide, wide), free)


def least_curvature(arm, goal: np.ndarray) -> float:
    """Of the distance to a goal along the fibre, where it starts; 1 on a straight fibre."""
    fibre = fibre_of(arm, goal)
    return float(np.linalg.eigvalsh(fibre.curvature(arm.q, fibre.tangent(arm.q)))[0])


def speed_limited(arm, acceleration: float = np.inf) -> JointLimits:
    v, a = np.full(arm.n, RATE), np.full(arm.n, acceleration)
    return JointLimits.unlimited(arm.n).with_pair("speed", -v, v).with_pair("acceleration", -a, a)


def governed_walk(arm, goal: np.ndarray, law: Trapezoid, ticks: int = 100) -> tuple[list[np.ndarray], float]:
    """Postures of ticks at a fixed pose, s of a tick.

    The reference goes the governed way under joint speeds of 1 rad/s; nothing bounds the ticks.
    """
    reference = governed_reference(way_of(arm, goal), law, speed_limited(arm))
    rows = [arm.q]
    for s in law.evaluate(np.linspace(0.0, law.duration, ticks + 1)[1:])[0]:
        solution = tick_towards(arm, rows[-1], reference(float(s)))
        if not solution.solved:
            break
        rows.append(solution.q)
    return rows, law.duration / ticks


def assert_governed(arm, goal: np.ndarray, rows: list[np.ndarray], dt: float, told: str) -> None:
    """Every tick solved, changes of speed below the governed rate of 1 rad/s in 0.2 s, distance falling."""
    assert len(rows) == 101, told
    speeds = np.diff(np.array([rows[0], *rows]), axis=0) / dt
    assert np.max(np.abs(np.diff(speeds, axis=0))) / dt <= GOVERNED, told
    away = [float(arm.weights @ (row - goal) ** 2) for row in rows]
    assert np.all(np.diff(away) <= 1e-9 * away[0]), told


@pytest.mark.req("TRF-05")
@pytest.mark.req("TRF-14")
@pytest.mark.parametrize("arm", first(1, ["arm7", "koch11"]), indirect=True)
@pytest.mark.parametrize("seeds", SEEDS, ids=str)
@pytest.mark.parametrize("away", [*(pytest.param(way, marks=pytest.mark.slow) for way in (1.0, 2.0)), 3.0])
def test_a_governed_reference_is_never_far(arm, away: float, seeds: range) -> None:
    """What a tick is drawn to is a step away however far the goal: it settles, and no joint jumps."""
    law = Trapezoid.fastest(1.0, 1.0, 1.0)
    for seed in seeds:
        goal = goal_of(arm, away, seed)
        rows, dt = governed_walk(arm, goal, law)
        assert_governed(arm, goal, rows, dt, f"seed {seed}, curvature {least_curvature(arm, goal):.3g}")


@pytest.mark.req("TRF-05")
@pytest.mark.parametrize("arm", first(1, ["arm7", "koch11"]), indirect=True)
@pytest.mark.parametrize("away", [1.0, *(pytest.param(way, marks=pytest.mark.slow) for way in (2.0, 3.0))])
@pytest.mark.parametrize("seeds", SEEDS, ids=str)
def test_a_whole_return_ends_in_the_best_posture(arm, away: float, seeds: range) -> None:
    """With time for all of the way the goal itself is the reference at last: its best posture is reached."""
    law = Trapezoid.fastest(1.0, 0.025, 1.0)
    for seed in seeds:
        goal = goal_of(arm, away, seed)
        way, told = way_of(arm, goal), f"seed {seed}"
        assert share_of_way(way, law, speed_limited(arm)) == 1.0, told
        rows, dt = governed_walk(arm, goal, law)
        assert_governed(arm, goal, rows, dt, told)
        assert np.all(governed_reference(way, law, speed_limited(arm))(1.0) == goal), told
        assert projected(arm, rows[-1], arm.weights * (rows[-1] - goal)) < 1e-6, told
        curvature = fibre_of(arm, goal).curvature(rows[-1], fibre_of(arm, goal).tangent(rows[-1]))
        assert np.linalg.eigvalsh(curvature)[0] > 0.0, told


@pytest.mark.req("TRF-05")
def test_a_goal_on_whose_slope_the_fibre_bends_away(koch11) -> None:
    """2 rad off the pose the goal's pull against the pose outweighs W: the best posture is no minimum."""
    goal = goal_of(koch11, 2.0, 4)
    curvature = least_curvature(koch11, goal)
    assert curvature < 0.0
    rows, dt = governed_walk(koch11, goal, Trapezoid.fastest(1.0, 1.0, 1.0))
    assert_governed(koch11, goal, rows, dt, f"curvature {curvature:.3g}")


@pytest.mark.req("TRF-05")
@pytest.mark.parametrize(
    ("name", "away", "seed", "dt", "acceleration"),
    [
        pytest.param(
            *hard, dt, acceleration, marks=() if by_default(hard, dt, acceleration) else pytest.mark.slow
        )
        for acceleration in (np.inf, GOVERNED)
        for dt in (2.5e-4, 1e-3, 1e-2, 5e-2)
        for hard in HARD
    ],
)
def test_the_way_is_kept_at_any_tick(request, name: str, away: float, seed: int, dt, acceleration) -> None:
    """Bounded ticks at a fixed pose: each on the way, no bound met, at rest with the reference.

    So nothing overshoots or rings; the promise is 1e-3 of the distance, found is below 1e-7.
    """
    arm = request.getfixturevalue(name)
    way, law = way_of(arm, goal_of(arm, away, seed)), Trapezoid.fastest(0.4, 1.0, 1.0)
    limits = speed_limited(arm, acceleration)
    share = share_of_way(way, law, limits)
    reference, limiter = governed_reference(way, law, limits), StepLimiter(limits, dt)
    solver, free = TickSolver(arm.kinematics, ProxQpSolver()), np.ones(arm.n, dtype=bool)
    ticks = int(np.ceil(law.duration / dt)) + 5
    due_s = law.evaluate(dt * np.arange(1, ticks + 1))[0]
    q, speed, rows = arm.q, np.zeros(arm.n), []
    for s in due_s:
        criterion = Posture(arm.weights, reference(float(s)))
        solution = solver.solve(TickProblem(arm.pose(arm.q), q, limiter.bounds(q, speed), criterion, free))
        assert solution.solved
        assert not np.any(solution.active)
        q, speed = solution.q, (solution.q - q) / dt
        rows.append(q)
    x = due_s / law.length
    due = way.postures(share * x**3 * (10.0 - 15.0 * x + 6.0 * x**2))
    length = float(np.linalg.norm(rows[-1] - arm.q))
    assert length > 1e-3
    assert np.max(np.abs(rows - due)) <= 1e-5 * length
    assert np.max(np.abs(np.diff(rows[-5:], axis=0))) <= 1e-9


@pytest.mark.req("TRF-05")
@pytest.mark.parametrize(
    ("name", "seed"),
    [
        ("arm7", 0),
        ("arm7", 1),
        ("koch11", 1),
        pytest.param("koch11", 2, marks=pytest.mark.slow),
        pytest.param("koch11", 0, marks=pytest.mark.slow),
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


@pytest.mark.req("MOT-05")
def test_a_posture_at_the_end_of_a_long_way_along_its_pose_is_found(koch11, monkeypatch) -> None:
    """From both starts some 50 steps, more than a tick may take."""
    monkeypatch.setattr("irlx.transform.posture_search.RESTARTS", 1)
    rng = np.random.default_rng([2, 5])
    goal = rng.uniform(np.maximum(koch11.lower, -3.0), np.minimum(koch11.upper, 3.0))
    pose = koch11.kinematics.tool_pose(goal)
    args = (koch11.q, koch11.weights, limits_of(koch11), np.ones(11, dtype=bool))
    found = nearest_posture(koch11.kinematics, ProxQpSolver(), *pose, *args).q
    assert found is not None
    np.testing.assert_allclose(koch11.kinematics.tool_pose(found)[1], pose[1], rtol=0, atol=1e-9)


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
    return closest(list(found), arm.kinematics.description.reach)


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


@pytest.mark.req("MOT-22")
@pytest.mark.parametrize("beyond", [0.0, 0.4])
def test_searches_side_by_side_find_what_each_finds_alone(arm7, beyond: float) -> None:
    """From every start, whether the pose can be reached or not; of frozen joints no bit changes."""
    rotation, position = arm7.kinematics.tool_pose(np.clip(arm7.q + 0.2, arm7.lower, arm7.upper))
    target = arm7.kinematics.target(rotation, position + beyond * np.array([3.0, 1.0, 2.0]))
    free = np.arange(7) != 2
    rng = np.random.default_rng(5)
    starts = [np.where(free, rng.uniform(arm7.lower, arm7.upper), arm7.q) for _ in range(9)]
    asked = arm7.lower, arm7.upper, free
    together = dict(nearest_from(arm7.kinematics, target, starts, *asked))
    assert sorted(together) == list(range(len(starts)))
    alone = [nearest_in_bounds(arm7.kinematics, target, start, *asked) for start in starts]
    best = [closest(list(found), arm7.kinematics.description.reach) for found in (together.values(), alone)]
    assert best[0].distance == pytest.approx(best[1].distance, rel=1e-7, abs=1e-9)
    assert best[0].angle == pytest.approx(best[1].angle, rel=1e-5, abs=1e-9)
    for k in range(len(starts)):
        assert together[k].distance == pytest.approx(alone[k].distance, rel=1e-3, abs=1e-7)
        assert together[k].q[2] == arm7.q[2]
        assert np.all((together[k].q >= arm7.lower) & (together[k].q <= arm7.upper))
    still = dict(nearest_from(arm7.kinematics, target, starts, *asked[:2], np.zeros(7, dtype=bool)))
    assert all(np.array_equal(still[k].q, start) for k, start in enumerate(starts))
