"""The posture flow: stays on the pose and inside, comes nearer with every point, ends at an optimum."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import minimize

from irlx.robot.limits import JointLimits
from irlx.transform.fibre import Fibre, Tangent
from irlx.transform.posture_flow import (
    FlowEnd,
    _follows,
    _shortened,
    _why,
    posture_flow,
    projected_gradient,
)
from irlx.transform.qp.dual import DualSolver
from irlx.transform.qp.proxqp import ProxQpSolver
from long_run import first

of_seven = pytest.mark.parametrize("arm", first(1, ["arm7", "koch11"]), indirect=True)
"""For what seven joints show as well as eleven, which cost more."""
FAR = [("arm7", 1e5), ("arm7", 1e300), ("koch11", 1e2), ("koch11", 1e5)]

OPTIMAL = 1e-8
ON_POSE = 1e-12


def limits_of(arm):
    return JointLimits.unlimited(arm.n).with_pair("position", arm.lower, arm.upper)


def flow_of(arm, q, konf, free=None, limits=None, qp=None):
    free = np.ones(arm.n, dtype=bool) if free is None else free
    limits = limits_of(arm) if limits is None else limits
    return posture_flow(arm.kinematics, q, konf, arm.weights, limits, free, qp or DualSolver())


def drawn(arm, rng, scale=1.0):
    return rng.uniform(np.maximum(arm.lower, -3.0), np.minimum(arm.upper, 3.0)) * scale


def pose_errors(arm, q, points):
    target = arm.pose(q)
    return np.array([np.max(np.abs(arm.kinematics.difference(point, target)[0])) for point in points])


def assert_good(arm, q, konf, free, flow, lower=None, upper=None):
    """All that is promised of any flow."""
    points = flow.points
    lower, upper = arm.lower if lower is None else lower, arm.upper if upper is None else upper
    assert points[0].tobytes() == q.tobytes()
    assert np.all(points[:, ~free] == q[~free])
    assert np.all((points >= lower) & (points <= upper))
    assert pose_errors(arm, q, points).max() <= ON_POSE
    assert flow.end in (FlowEnd.KONF, FlowEnd.NEAREST), flow
    assert flow.projected_gradient < OPTIMAL
    away = ((points - konf) ** 2 * arm.weights)[:, free].sum(axis=1)
    assert np.max(np.diff(away), initial=-1.0) <= 1e-12 * (1.0 + away[0])
    assert np.max(np.abs(flow.remaining - (konf - points[-1]))) <= 2e-12
    if len(points) > 1:
        assert_even(points)


def assert_even(points):
    """Spacing as promised, and no way turned by more than a quarter of a right angle from point to point."""
    steps = np.diff(points, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    assert lengths.max() <= 0.03
    assert lengths.max() <= 1.5 * lengths.min()
    if lengths.max() > 1e-6:
        ways = steps / lengths[:, None]
        assert np.min(np.sum(ways[1:] * ways[:-1], axis=1)) > np.cos(np.pi / 8)


@pytest.mark.req("TRF-05")
@pytest.mark.req("TRF-15")
@pytest.mark.parametrize(
    ("name", "seeds"),
    [
        ("arm7", range(5)),
        ("koch11", range(3)),
        pytest.param("arm7", range(5, 70), marks=pytest.mark.slow),
        pytest.param("koch11", range(3, 20), marks=pytest.mark.slow),
    ],
)
def test_random_postures(name, seeds, request):
    arm = request.getfixturevalue(name)
    most_frozen = arm.n - 7
    for seed in seeds:
        rng = np.random.default_rng([seed, arm.n])
        q, konf = drawn(arm, rng), drawn(arm, rng, 1.3 if seed % 3 == 0 else 1.0)
        free = np.ones(arm.n, dtype=bool)
        if seed % 4 == 1:
            joint = int(rng.integers(arm.n))
            q[joint] = arm.lower[joint] if seed % 8 == 1 else arm.upper[joint]
        if seed % 4 == 2 and most_frozen > 0:
            free[rng.choice(arm.n, int(rng.integers(1, most_frozen + 1)), replace=False)] = False
        try:
            assert_good(arm, q, konf, free, flow_of(arm, q, konf, free))
        except AssertionError:
            print(f"{name}: seed {seed}")
            raise


@pytest.mark.req("TRF-15")
@pytest.mark.parametrize("seeds", first(1, [range(4), range(4, 56)]), ids=str)
def test_six_joints_with_a_way_to_spare_use_it(arm7, seeds):
    """The elbow frozen, between a spherical shoulder and wrist; other joints on their limits now and then."""
    arm, free = arm7, np.arange(7) != 3
    lengths = []
    for seed in seeds:
        rng = np.random.default_rng([seed, 4])
        q, konf = drawn(arm, rng), drawn(arm, rng)
        if seed % 4 == 1:
            joint = int(rng.integers(arm.n))
            q[joint] = arm.lower[joint] if seed % 8 == 1 else arm.upper[joint]
        flow = flow_of(arm, q, konf, free)
        assert_good(arm, q, konf, free, flow)
        lengths.append(len(flow.points))
    # Joints that are pressed against their limits may hold all the others.
    assert sum(length > 5 for length in lengths) > 0.75 * len(lengths)


@pytest.mark.req("TRF-15")
@of_seven
@pytest.mark.parametrize("seeds", first(1, [range(3), range(3, 20)]), ids=str)
def test_a_posture_on_the_fibre_is_reached_to_the_last_bit(arm, seeds):
    free = np.ones(arm.n, dtype=bool)
    for seed in seeds:
        rng = np.random.default_rng([seed, 3])
        q = arm.q
        way = flow_of(arm, q, drawn(arm, rng)).points
        konf = way[min(len(way) - 1, 25)].copy()
        flow = flow_of(arm, q, konf)
        assert_good(arm, q, konf, free, flow)
        assert flow.reached, seed
        assert flow.end is FlowEnd.KONF
        # Values that mean those of the start are those of the start: nothing moves for rounding.
        meant = np.where(np.abs(konf - q) <= 1e-12, q, konf)
        assert flow.points[-1].tobytes() == meant.tobytes()
        assert np.all(flow.remaining == 0.0)


def test_a_posture_almost_on_the_fibre_is_not_taken_over(arm):
    way = flow_of(arm, arm.q, drawn(arm, np.random.default_rng(8))).points
    konf = way[len(way) // 2].copy()
    konf[0] += 1e-7
    flow = flow_of(arm, arm.q, konf)
    assert flow.reached
    assert np.any(flow.points[-1] != konf)
    assert pose_errors(arm, arm.q, flow.points).max() <= ON_POSE


@pytest.mark.parametrize("residue", [0.0, 1e-16, -3e-16, 1e-13])
def test_nothing_moves_towards_the_present_posture(arm, residue):
    flow = flow_of(arm, arm.q, arm.q + residue)
    assert len(flow.points) == 1
    assert flow.reached
    assert flow.points[0].tobytes() == arm.q.tobytes()


@of_seven
@pytest.mark.parametrize("count", [1, pytest.param(8, marks=pytest.mark.slow)])
def test_the_end_does_not_depend_on_the_qp_solver(arm, count):
    rng = np.random.default_rng(21)
    for _ in range(count):
        konf = drawn(arm, rng, 1.2)
        one, other = (flow_of(arm, arm.q, konf, qp=qp) for qp in (DualSolver(), ProxQpSolver()))
        assert np.max(np.abs(one.points[-1] - other.points[-1])) <= 1e-8


@pytest.mark.req("TRF-05")
@of_seven
def test_another_solver_finds_no_nearer_posture(arm):
    """SLSQP, started beside the end, comes back to it."""
    free = np.ones(arm.n, dtype=bool)
    for seed in range(4):
        rng = np.random.default_rng([seed, 77])
        konf = drawn(arm, rng, 1.2 if seed % 2 else 1.0)
        flow = flow_of(arm, arm.q, konf)
        assert_good(arm, arm.q, konf, free, flow)
        end, target = flow.points[-1], arm.pose(arm.q)
        found = minimize(
            lambda x, k=konf: 0.5 * (arm.weights * (x - k)) @ (x - k),
            np.clip(end + rng.normal(size=arm.n) * 1e-3, arm.lower, arm.upper),
            jac=lambda x, k=konf: arm.weights * (x - k),
            bounds=list(zip(arm.lower, arm.upper, strict=True)),
            constraints={
                "type": "eq",
                "fun": lambda x, t=target: arm.kinematics.difference(x, t)[0],
                "jac": lambda x, t=target: arm.kinematics.difference_derivative(x, t)[1],
            },
            method="SLSQP",
            options={"ftol": 1e-15, "maxiter": 500},
        )
        best = 0.5 * (arm.weights * (end - konf)) @ (end - konf)
        assert found.fun >= best - 1e-7 * (1.0 + best), seed
        assert np.max(np.abs(found.x - end)) < 2e-3, seed


def test_narrow_limits_hold_and_are_left(arm):
    """A joint pressed against its limit stays on it to the last bit; one that may leave it leaves."""
    rng = np.random.default_rng(4)
    for _ in range(5):
        lower, upper = arm.q - 0.05, arm.q + 0.05
        lower[arm.n - 2] = arm.q[arm.n - 2]
        limits = limits_of(arm).with_pair("position", lower, upper)
        konf = arm.q + rng.normal(size=arm.n)
        flow = flow_of(arm, arm.q, konf, limits=limits)
        assert_good(arm, arm.q, konf, np.ones(arm.n, dtype=bool), flow, lower, upper)


@pytest.mark.parametrize(
    ("arm", "far"),
    [("arm7", 1e2), ("koch11", 1e300), *(pytest.param(*case, marks=pytest.mark.slow) for case in FAR)],
    indirect=["arm"],
)
def test_a_posture_far_beyond_everything(arm, far):
    """Only the direction counts; the flow ends, within the limits, and says what is left."""
    konf = far * np.random.default_rng(3).normal(size=arm.n)
    flow = flow_of(arm, arm.q, konf)
    assert flow.end is FlowEnd.NEAREST
    assert pose_errors(arm, arm.q, flow.points).max() <= ON_POSE
    assert np.all((flow.points >= arm.lower) & (flow.points <= arm.upper))
    assert np.array_equal(flow.remaining, konf - flow.points[-1])


def test_frozen_to_the_last_spare_joint_nothing_moves(arm7):
    free = np.ones(7, dtype=bool)
    free[2] = False
    flow = flow_of(arm7, arm7.q, np.zeros(7), free)
    assert len(flow.points) == 1
    assert not flow.reached
    assert np.array_equal(flow.remaining, -arm7.q)


@pytest.mark.parametrize("arm", ["arm7", pytest.param("koch11", marks=pytest.mark.slow)], indirect=True)
def test_a_ridge_is_left(arm):
    """Where the distance is level at the start but highest across, the flow leaves to one side."""
    free = np.ones(arm.n, dtype=bool)
    jacobian = np.array(arm.kinematics.difference(arm.q, arm.pose(arm.q))[1])
    left = 0
    for seed in range(20):
        force = np.random.default_rng([seed, 9]).normal(size=6) * 40.0
        konf = arm.q + jacobian.T @ force / arm.weights
        given = arm.kinematics, arm.q, konf, arm.weights, limits_of(arm), free
        assert projected_gradient(*given) < 1e-12
        flow = flow_of(arm, arm.q, konf)
        assert_good(arm, arm.q, konf, free, flow)
        left += len(flow.points) > 10
    assert left > 0


def test_a_singular_start_ends_with_a_reason(arm7):
    """Stretched out, the arm has lost a direction: whatever comes out is on the pose and inside."""
    q = np.zeros(7)
    konf = np.array([0.3, 0.4, -0.2, 0.5, 0.1, 0.2, 0.3])
    flow = flow_of(arm7, q, konf)
    assert flow.end in FlowEnd
    assert pose_errors(arm7, q, flow.points).max() <= ON_POSE
    assert np.all((flow.points >= arm7.lower) & (flow.points <= arm7.upper))


def test_projected_gradient_is_the_slope_along_the_fibre(arm7):
    """Against differences of the distance along the one tangent of a 7-axis arm."""
    konf = np.array([0.1, 0.2, -1.0, 1.1, 0.9, -0.3, 0.2])
    free = np.ones(7, dtype=bool)
    _, jacobian = arm7.kinematics.difference(arm7.q, arm7.pose(arm7.q))
    way = np.linalg.svd(np.array(jacobian))[2][-1]
    slope = way @ (arm7.weights * (arm7.q - konf))
    expected = abs(slope) * np.max(np.abs(way))
    found = projected_gradient(arm7.kinematics, arm7.q, konf, arm7.weights, limits_of(arm7), free)
    assert abs(found - expected) < 1e-12
    # Pressed against a limit the only way is closed.
    joint = int(np.argmax(np.abs(way)))
    outward = -np.sign(slope * way[joint])
    side = "position"
    lower, upper = arm7.lower.copy(), arm7.upper.copy()
    (upper if outward > 0 else lower)[joint] = arm7.q[joint]
    held = replace(limits_of(arm7)).with_pair(side, lower, upper)
    assert projected_gradient(arm7.kinematics, arm7.q, konf, arm7.weights, held, free) == 0.0


@pytest.mark.req("TRF-15")
@pytest.mark.parametrize("side", first(2, ["lower", "upper", "both"]))
def test_an_elbow_on_its_limit_holds_nobody(arm7, side):
    """With spherical shoulder and wrist the pose alone decides the elbow: the others go round it."""
    free = np.ones(7, dtype=bool)
    konf = flow_of(arm7, arm7.q, drawn(arm7, np.random.default_rng(8)), free).points[-1].copy()
    konf[3] = arm7.q[3]
    lower, upper = arm7.lower.copy(), arm7.upper.copy()
    if side in {"lower", "both"}:
        lower[3] = arm7.q[3]
    if side in {"upper", "both"}:
        upper[3] = arm7.q[3]
    narrow = JointLimits.unlimited(7).with_pair("position", lower, upper)
    flow = posture_flow(arm7.kinematics, arm7.q, konf, arm7.weights, narrow, free, ProxQpSolver())
    assert np.max(np.abs(konf - arm7.q)) > 0.05
    assert np.max(np.abs(flow.remaining)) <= 1e-6
    assert np.all((flow.points >= lower) & (flow.points <= upper))
    assert pose_errors(arm7, arm7.q, flow.points).max() <= ON_POSE


@pytest.mark.parametrize("seed", first(2, range(4)))
def test_a_coarse_flow_is_the_same_but_for_the_last_digits(arm, seed):
    print("seed", seed)
    rng = np.random.default_rng(seed)
    q, free = drawn(arm, rng, 0.5), rng.random(arm.n) < 0.9
    arguments = (arm.kinematics, q, drawn(arm, rng, 0.5), arm.weights, limits_of(arm), free, DualSolver())
    fine, coarse = posture_flow(*arguments), posture_flow(*arguments, True)
    assert coarse.end is fine.end
    assert coarse.points.shape == fine.points.shape
    np.testing.assert_allclose(coarse.points, fine.points, atol=2e-6)
    assert pose_errors(arm, q, coarse.points).max() <= ON_POSE


@pytest.mark.req("TRF-05")
@pytest.mark.parametrize("away", [0.3, -0.3])
def test_a_posture_that_is_not_reached_is_not_called_so(arm7, away):
    """Six free joints hold the pose by themselves: the flow stays, whichever side the posture lies on."""
    free = np.ones(7, dtype=bool)
    free[2] = False
    flow = flow_of(arm7, arm7.q, arm7.q + away, free)
    assert not flow.reached
    assert len(flow.points) == 1
    np.testing.assert_allclose(flow.remaining, away, rtol=0, atol=1e-15)
    assert flow_of(arm7, arm7.q, arm7.q, free).reached


@pytest.mark.req("TRF-15")
def test_a_joint_that_came_to_its_limit_stays_on_it_to_the_last_bit(koch11):
    """Corrections back onto the pose move the others."""
    konf = koch11.q + np.random.default_rng(8).normal(size=11) * 0.3
    upper = koch11.upper.copy()
    joint = 7
    upper[joint] = koch11.q[joint] + 0.02
    limits = JointLimits.unlimited(11).with_pair("position", koch11.lower, upper)
    iterates = flow_of(koch11, koch11.q, konf, limits=limits).iterates
    came = int(np.argmax(upper[joint] - iterates[:, joint] <= 1e-6))
    assert 0 < came < len(iterates) - 4
    assert np.all(iterates[came:, joint] == upper[joint])


def test_a_step_that_leads_too_far_is_halved_though_a_joint_is_frozen(koch11):
    """Six times the way to the nearest posture nearby, then three times, then one and a half times it."""
    free = np.arange(11) != 4
    konf = koch11.q + np.random.default_rng(3).normal(size=11) * 0.01
    bounds = (koch11.lower, koch11.upper)
    fibre = Fibre(koch11.kinematics, koch11.pose(koch11.q), konf, koch11.weights, bounds, free)
    tangent = fibre.tangent(koch11.q)
    newton = -tangent.basis @ (tangent.basis.T @ tangent.gradient)
    assert newton[4] == 0.0
    new, after = _shortened(fibre, koch11.q, tangent, 6.0 * newton)
    # On a parabola 6 and 3 times the way to its bottom lie higher than its start, 1.5 times does not.
    np.testing.assert_allclose(new - koch11.q, 1.5 * newton, atol=0.1 * np.max(np.abs(newton)))
    assert fibre.distance(new) < fibre.distance(koch11.q)
    assert after.projected < tangent.projected


@pytest.mark.parametrize(("least", "end"), [(0.9e-4, FlowEnd.SINGULAR), (1.1e-4, FlowEnd.STALLED)])
def test_a_flow_ends_singular_by_the_ratio_of_least_and_largest(least, end):
    """The largest singular value is 1, the next one 0.1."""
    tangent = Tangent(
        np.ones(4, bool), np.zeros((4, 1)), np.eye(3, 4) * [1.0, 0.1, least, 0], np.ones(4), 1.0
    )
    fibre = SimpleNamespace(kinematics=SimpleNamespace(row_scale=np.ones(3)), rank=lambda *_: 3)
    assert _why(fibre, np.zeros(4), tangent) is end


@pytest.mark.parametrize(("length", "most"), [(0.01, 0.0025), (1e-6, 1e-5)])
def test_a_way_back_onto_the_pose_is_a_correction_up_to_a_quarter_of_the_step(length, most):
    """Of a joint by itself; of next to nothing always."""
    step = length * np.array([0.6, -1.0, 0.2])
    for share, follows in ((0.99, True), (1.01, False)):
        assert _follows(np.ones(3), step, np.ones(3) + step + [0.0, share * most, 0.5 * most]) is follows
