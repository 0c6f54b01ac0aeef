"""The governed reference: begins where the posture is, ends as near as half the limits allow."""

from __future__ import annotations

import daqp
import numpy as np
import pytest

from irlx.motion.trapezoid import Trapezoid
from irlx.pacing.governed_return import governed_reference, way_to_best
from irlx.robot.limits import JointLimits
from irlx.transform.qp.proxqp import ProxQpSolver
from machines import machine
from slow_cases import jacobian_at

pytestmark = pytest.mark.req("TRF-20")

LAWS = [
    Trapezoid.fastest(0.4, 0.25, 1.5),
    Trapezoid.fastest(0.02, 0.25, 1.5),
    Trapezoid.fastest(3.0, 0.5, 0.4),
]
laws = pytest.mark.parametrize("law", LAWS, ids=["trapezoid", "triangle", "long"])


def drawn(seed: int, n: int = 9) -> tuple[np.ndarray, np.ndarray]:
    """Goal and way to it."""
    rng = np.random.default_rng(seed)
    return rng.normal(size=n), rng.normal(size=n)


def unlimited(n: int = 9) -> JointLimits:
    return JointLimits.unlimited(n)


def limited(speed: float, acc: float, n: int = 9) -> JointLimits:
    v, a = np.full(n, speed), np.full(n, acc)
    return unlimited(n).with_pair("speed", -v, v).with_pair("acceleration", -a, a)


# ---- the way to the best posture


def case(name: str, seed: int):
    """A robot, its start as posture, and a goal some way off."""
    robot = machine(name)
    return robot, robot.start + 0.3 * np.random.default_rng(seed).normal(size=robot.n)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", ["arm7", "koch11"])
def test_the_way_ends_where_the_pull_along_the_null_space_vanishes(name: str, seed: int) -> None:
    robot, goal = case(name, seed)
    way = way_to_best(robot.model(robot.unlimited()), robot.start, goal, ProxQpSolver())
    jacobian = jacobian_at(robot, robot.start)
    null_space = np.linalg.svd(jacobian)[2][6:].T
    assert np.max(np.abs(jacobian @ way)) < 1e-7
    assert np.max(np.abs(null_space.T @ (robot.weights * (robot.start + way - goal)))) < 1e-7


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", ["arm7", "koch11"])
def test_the_best_posture_of_the_reference_at_the_start_is_the_one_it_stands_in(name: str, seed: int) -> None:
    robot, goal = case(name, seed)
    way = way_to_best(robot.model(robot.unlimited()), robot.start, goal, ProxQpSolver())
    null_space = np.linalg.svd(jacobian_at(robot, robot.start))[2][6:].T
    for limits in (robot.unlimited(), limited(0.1, 0.3, robot.n)):
        reference = governed_reference(goal, way, LAWS[0], limits)
        assert np.max(np.abs(null_space.T @ (robot.weights * (reference(0.0) - robot.start)))) < 1e-7


@pytest.mark.parametrize("name", ["arm7", "koch11"])
def test_joints_on_a_limit_do_not_go_beyond_it(name: str) -> None:
    """Against a second quadratic solver: the same way with one joint held by its limit."""
    robot, goal = case(name, 1)
    free = way_to_best(robot.model(robot.unlimited()), robot.start, goal, ProxQpSolver())
    joint = int(np.argmax(free))
    upper = np.where(np.arange(robot.n) == joint, robot.start, np.inf)
    limits = robot.unlimited().with_pair("position", np.full(robot.n, -np.inf), upper)
    way = way_to_best(robot.model(limits), robot.start, goal, ProxQpSolver())
    rows, none = np.vstack([jacobian_at(robot, robot.start), np.eye(robot.n)[joint]]), np.zeros(7)
    pull = robot.weights * (robot.start - goal)
    wanted, _, flag, _ = daqp.solve(np.diag(robot.weights), pull, rows, none, np.append(none[:6], -1e30))
    assert flag == 1
    np.testing.assert_allclose(way, wanted, atol=1e-7)
    assert way[joint] <= 0.0


def test_frozen_joints_have_no_part_in_the_way() -> None:
    robot, goal = case("koch11", 2)
    way = way_to_best(robot.model(robot.unlimited(), (1, 4)), robot.start, goal, ProxQpSolver())
    assert np.all(way[[1, 4]] == 0.0)
    assert np.max(np.abs(way)) > 1e-3


def test_a_robot_without_freedom_has_nowhere_to_go() -> None:
    robot, goal = case("arm7", 2)
    way = way_to_best(robot.model(robot.unlimited(), (2,)), robot.start, goal, ProxQpSolver())
    assert np.max(np.abs(way)) < 1e-12


# ---- the reference


@laws
def test_without_a_way_the_goal_is_the_reference(law: Trapezoid) -> None:
    goal, _ = drawn(1)
    reference = governed_reference(goal, np.zeros(9), law, limited(1e-3, 1e-3))
    assert all(np.all(reference(s) == goal) for s in np.linspace(0.0, law.length, 7))


@laws
def test_unlimited_joints_go_all_the_way(law: Trapezoid) -> None:
    goal, way = drawn(3)
    reference = governed_reference(goal, way, law, unlimited())
    np.testing.assert_allclose(reference(law.length), goal, atol=1e-14)
    np.testing.assert_allclose(reference(2.0 * law.length), goal, atol=1e-14)
    assert np.all(reference(-1.0) == reference(0.0))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(("speed", "acc"), [(0.3, 5.0), (5.0, 0.3), (0.2, np.inf), (0.05, 0.05)])
@laws
def test_half_the_limits_are_kept_in_time(law: Trapezoid, speed: float, acc: float, seed: int) -> None:
    """The reference sampled along the law: speeds and accelerations by differences."""
    goal, way = drawn(seed)
    reference = governed_reference(goal, way, law, limited(speed, acc))
    times = np.linspace(0.0, law.duration, 4001)
    rows = np.array([reference(s) for s in law.evaluate(times)[0]])
    v = np.diff(rows, axis=0) / times[1]
    a = np.diff(v, axis=0) / times[1]
    hardest = acc if np.isfinite(acc) else speed / 0.2
    assert np.max(np.abs(v)) <= 0.5 * speed * (1.0 + 1e-6)
    assert np.max(np.abs(a)) <= 0.5 * hardest * (1.0 + 1e-4)
    assert np.max(np.abs(v[[0, -1]])) <= 1e-3 * speed


def test_narrower_limits_leave_more_of_the_way() -> None:
    goal, way = drawn(4)
    left = [
        np.linalg.norm(governed_reference(goal, way, LAWS[0], limited(v, v))(0.4) - goal)
        for v in (100.0, 1.0, 0.1, 0.0)
    ]
    assert left[0] < 1e-12
    assert left[0] < left[1] < left[2] < left[3]


def test_asymmetric_limits_count_by_their_narrower_side() -> None:
    goal, way = drawn(5)
    v = np.full(9, 0.2)
    one_sided = unlimited().with_pair("speed", -v, 5.0 * v)
    wanted = governed_reference(goal, way, LAWS[0], unlimited().with_pair("speed", -v, v))
    found = governed_reference(goal, way, LAWS[0], one_sided)
    np.testing.assert_allclose(found(0.4), wanted(0.4), atol=1e-14)
