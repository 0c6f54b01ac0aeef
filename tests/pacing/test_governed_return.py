"""The governed reference: begins where the posture is, ends as near as half the limits allow."""

from __future__ import annotations

import daqp
import numpy as np
import pytest

from irlx.motion.trapezoid import Trapezoid
from irlx.pacing.governed_return import governed_reference, share_of_way
from irlx.pacing.return_way import SAFE_BEND, ReturnWay, _references, return_way, through
from irlx.robot.limits import JointLimits
from irlx.transform.fibre import Fibre
from irlx.transform.posture_flow import posture_flow
from irlx.transform.qp.proxqp import ProxQpSolver
from long_run import first
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


def way_of(robot, goal: np.ndarray, limits: JointLimits | None = None, frozen=()) -> ReturnWay | None:
    model = robot.model(robot.unlimited() if limits is None else limits, frozen)
    return return_way(model, robot.start, goal, ProxQpSolver())


def along(robot, q: np.ndarray) -> np.ndarray:
    """Orthonormal basis (n, r) of what moves along the fibre at q."""
    return np.linalg.svd(jacobian_at(robot, q))[2][6:].T


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", ["arm7", "koch11"])
def test_the_way_keeps_the_pose_and_ends_where_the_pull_along_it_vanishes(name: str, seed: int) -> None:
    robot, goal = case(name, seed)
    way = way_of(robot, goal)
    end, pose = way.postures(1.0), robot.pose(robot.start)
    assert np.all(way.postures(0.0) == pytest.approx(robot.start, abs=1e-14))
    for p in np.linspace(0.0, 1.0, 41):
        for wanted, found in zip(pose, robot.pose(way.postures(p)), strict=True):
            np.testing.assert_allclose(found, wanted, atol=1e-6)
    assert np.max(np.abs(along(robot, end).T @ (robot.weights * (end - goal)))) < 1e-7
    assert robot.weights @ (end - goal) ** 2 < robot.weights @ (robot.start - goal) ** 2
    assert np.all(way.reference(1.0) == goal)


@pytest.mark.parametrize("seed", first(1, range(3)))
@pytest.mark.parametrize("name", ["arm7", "koch11"])
def test_each_posture_of_the_way_is_the_best_one_for_its_reference(name: str, seed: int) -> None:
    """And safely so: what the reference pulls against the pose bends the distance by 0.4 at most, but near
    the end. The bend here by differences of the distance along the fibre, led back onto the pose."""
    robot, goal = case(name, seed)
    way = way_of(robot, robot.start + 4.0 * (goal - robot.start))
    for p in np.linspace(0.0, 1.0, 21):
        q, reference = way.postures(p), way.references(p)
        pull = robot.weights * (reference - q)
        # Between its points a spline leaves the fibre a little.
        assert np.max(np.abs(along(robot, q).T @ pull)) < 1e-4
    q, reference = way.postures(0.0), way.references(0.0)
    if np.linalg.norm(way.postures(1.0) - q) < 0.5:
        return
    fibre = Fibre(
        robot.kinematics,
        robot.kinematics.target(*robot.kinematics.tool_pose(q)),
        reference,
        robot.weights,
        (np.full(robot.n, -np.inf), np.full(robot.n, np.inf)),
        np.ones(robot.n, dtype=bool),
    )
    for tangent in (along(robot, q) @ np.random.default_rng(seed).normal(size=(robot.n - 6, 5))).T:
        step = 3e-3 * tangent / np.sqrt(robot.weights @ tangent**2)
        sides = [fibre.onto_pose(q + side * step) for side in (1.0, -1.0)]
        second = sum(fibre.distance(side) for side in sides) - 2.0 * fibre.distance(q)
        assert abs(second / (robot.weights @ step**2) - 1.0) <= SAFE_BEND + 1e-2


@pytest.mark.parametrize("name", ["arm7", "koch11"])
def test_the_best_posture_of_the_reference_at_the_start_is_the_one_it_stands_in(name: str) -> None:
    for seed in range(3):
        robot, goal = case(name, seed)
        way = way_of(robot, goal)
        for limits in (robot.unlimited(), limited(0.1, 0.3, robot.n)):
            pull = robot.weights * (governed_reference(way, LAWS[0], limits)(0.0) - robot.start)
            assert np.max(np.abs(along(robot, robot.start).T @ pull)) < 1e-7


@pytest.mark.parametrize("name", ["arm7", "koch11"])
def test_joints_on_a_limit_do_not_go_beyond_it(name: str) -> None:
    """Against a second quadratic solver: where one joint is held by its limit, the end is the best of all
    linearised steps that keep the limit."""
    robot, goal = case(name, 1)
    joint = int(np.argmax(way_of(robot, goal).postures(1.0) - robot.start))
    upper = np.where(np.arange(robot.n) == joint, robot.start, np.inf)
    limits = robot.unlimited().with_pair("position", np.full(robot.n, -np.inf), upper)
    way = way_of(robot, goal, limits)
    end = robot.start if way is None else way.postures(1.0)
    if way is not None:
        assert np.max(way.postures(np.linspace(0.0, 1.0, 101))[:, joint]) <= robot.start[joint] + 1e-9
    rows, none = np.vstack([jacobian_at(robot, end), np.eye(robot.n)[joint]]), np.zeros(7)
    highest = np.append(none[:6], upper[joint] - end[joint])
    best, _, flag, _ = daqp.solve(
        np.diag(robot.weights), robot.weights * (end - goal), rows, highest, np.append(none[:6], -1e30)
    )
    assert flag == 1
    np.testing.assert_allclose(best, 0.0, atol=1e-7)


def test_frozen_joints_have_no_part_in_the_way() -> None:
    robot, goal = case("koch11", 2)
    way = way_of(robot, goal, frozen=(1, 4))
    postures = way.postures(np.linspace(0.0, 1.0, 21))
    np.testing.assert_allclose(postures[:, [1, 4]] - robot.start[[1, 4]], 0.0, atol=1e-14)
    assert np.max(np.abs(postures[-1] - robot.start)) > 1e-3


def test_a_robot_without_freedom_has_nowhere_to_go() -> None:
    robot, goal = case("arm7", 2)
    assert way_of(robot, goal, frozen=(2,)) is None


@pytest.mark.parametrize("name", ["arm7", "koch11"])
def test_the_best_posture_has_no_way_before_it(name: str) -> None:
    """Neither for a goal with the same pose nor for one whose pull is all against the pose."""
    robot, _ = case(name, 0)
    against = jacobian_at(robot, robot.start).T @ np.random.default_rng(1).normal(size=6)
    against *= 0.05 / np.max(np.abs(against))
    assert way_of(robot, robot.start.copy()) is None
    assert way_of(robot, robot.start + against / robot.weights) is None


# ---- the reference


def straight(goal: np.ndarray, way: np.ndarray) -> ReturnWay:
    """A way of no bend, as on a straight fibre, with references as far from it as the goal is."""
    p = np.linspace(0.0, 1.0, 9)[:, None]
    return through(goal, goal - (1.0 - p) * way - 1.0, goal - (1.0 - p) * way)


def bent(goal: np.ndarray, way: np.ndarray) -> ReturnWay:
    """A half circle of that way."""
    angle = np.pi * np.linspace(0.0, 1.0, 65)[:, None]
    radius = 0.5 * np.linalg.norm(way)
    across = np.roll(way, 1) - way * (way @ np.roll(way, 1)) / (way @ way)
    across = radius * across / np.linalg.norm(across)
    turn = goal - 0.5 * way - 0.5 * way * np.cos(angle) + across * np.sin(angle)
    return through(goal, turn, turn)


@laws
def test_unlimited_joints_go_all_the_way(law: Trapezoid) -> None:
    goal, way = drawn(3)
    reference = governed_reference(straight(goal, way), law, unlimited())
    assert np.all(reference(law.length) == goal)
    assert np.all(reference(2.0 * law.length) == goal)
    assert np.all(reference(-1.0) == reference(0.0))


@pytest.mark.parametrize("shape", [straight, bent])
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(("speed", "acc"), [(0.3, 5.0), (5.0, 0.3), (0.2, np.inf), (0.05, 0.05)])
@laws
def test_half_the_limits_are_kept_in_time(law: Trapezoid, speed: float, acc: float, seed: int, shape) -> None:
    """The way sampled along the law: speeds and accelerations by differences."""
    way = shape(*drawn(seed))
    limits = limited(speed, acc)
    share = share_of_way(way, law, limits)
    times = np.linspace(0.0, law.duration, 4001)
    x = law.evaluate(times)[0] / law.length
    rows = way.postures(share * x**3 * (10.0 - 15.0 * x + 6.0 * x**2))
    reference = governed_reference(way, law, limits)
    apart = [reference(s) - row for s, row in zip(law.length * x[:-1:100], rows[:-1:100], strict=True)]
    np.testing.assert_allclose(apart, 1.0 if shape is straight else 0.0, atol=1e-9)
    v = np.diff(rows, axis=0) / times[1]
    a = np.diff(v, axis=0) / times[1]
    hardest = acc if np.isfinite(acc) else speed / 0.2
    assert share > 0.0
    assert np.max(np.abs(v)) <= 0.5 * speed * (1.0 + 1e-6)
    assert np.max(np.abs(a)) <= 0.5 * hardest * (1.0 + 1e-4)
    assert np.max(np.abs(v[[0, -1]])) <= 1e-3 * speed


def test_narrower_limits_leave_more_of_the_way() -> None:
    goal, way = drawn(4)
    left = [
        np.linalg.norm(governed_reference(straight(goal, way), LAWS[0], limited(v, v))(0.4) - goal)
        for v in (100.0, 1.0, 0.1, 0.0)
    ]
    assert left[0] < 1e-12
    assert left[0] < left[1] < left[2] < left[3]


def test_asymmetric_limits_count_by_their_narrower_side() -> None:
    goal, way = drawn(5)
    v = np.full(9, 0.2)
    one_sided = unlimited().with_pair("speed", -v, 5.0 * v)
    both = unlimited().with_pair("speed", -v, v)
    wanted = governed_reference(straight(goal, way), LAWS[0], both)
    found = governed_reference(straight(goal, way), LAWS[0], one_sided)
    np.testing.assert_allclose(found(0.4), wanted(0.4), atol=1e-14)


@laws
def test_before_its_start_and_behind_its_end_a_move_is_drawn_to_what_its_ends_are(law: Trapezoid) -> None:
    """Rounding may lead a hair beyond either; a share of the way stays that share."""
    goal, way = drawn(6)
    reference = governed_reference(bent(goal, way), law, limited(0.05, 0.05))
    assert np.linalg.norm(reference(law.length) - goal) > 0.1
    for beyond in (1e-9, 0.3, 5.0):
        assert np.array_equal(reference(law.length + beyond), reference(law.length))
        assert np.array_equal(reference(-beyond), reference(0.0))


@pytest.mark.parametrize(("seed", "times", "whole"), [(1, 4.0, True), (3, 8.0, True), (3, 4.0, False)])
def test_the_pull_against_the_pose_is_what_the_bend_allows(seed: int, times: float, whole: bool) -> None:
    """At every point of a flow: all of the goal's at the end of a whole way, and as much as leaves a bend of
    `SAFE_BEND` up to half a radian before it; between, the bend that is left rises with the way."""
    robot, goal = case("arm7", seed)
    model, goal = robot.model(robot.unlimited()), robot.start + times * (goal - robot.start)
    flow = posture_flow(
        model.kinematics, robot.start, goal, model.weights, model.limits, model.movable, ProxQpSolver()
    )
    ways = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(flow.points, axis=0), axis=1)))
    bends, shares = [], []
    for point, reference in zip(flow.points, _references(flow, goal, whole), strict=True):
        tangent = flow.fibre.tangent(point)
        curved = flow.fibre.curvature(point, tangent) - np.eye(tangent.basis.shape[1])
        bends.append(np.max(np.abs(np.linalg.eigvalsh(curved))))
        along_pose, weights = along(robot, point), robot.weights
        # W-orthogonal to the fibre: what of the goal's pull is against the pose.
        inner = along_pose @ np.linalg.solve((along_pose.T * weights) @ along_pose, along_pose.T * weights)
        against = (goal - point) - inner @ (goal - point)
        shares.append((weights * against) @ (reference - point) / ((weights * against) @ against))
        np.testing.assert_allclose(reference - point, shares[-1] * against, atol=1e-7)
    left = ways[-1] - ways
    steep = max(bends[-1], SAFE_BEND) if whole else SAFE_BEND
    most = SAFE_BEND + (steep - SAFE_BEND) * np.clip(1.0 - left / 0.5, 0.0, 1.0)
    np.testing.assert_allclose(shares, np.minimum(1.0, most / np.array(bends)), rtol=1e-6)
