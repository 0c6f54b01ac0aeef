"""Figures of the summary against brute force over all rows and joints."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.report.summary import closure, limit_uses
from irlx.robot.limits import JointLimits

NAMES = ("j1", "j2", "j3", "j4")


def limits(seed: int) -> JointLimits:
    rng = np.random.default_rng(seed)
    lower, upper = -rng.uniform(0.1, 3.0, (3, 4)), rng.uniform(0.1, 3.0, (3, 4))
    return JointLimits(lower[0], upper[0], lower[1], upper[1], lower[2], upper[2])


def by_brute_force(values: np.ndarray, lower: np.ndarray, upper: np.ndarray, about_middle: bool):
    """Largest share of the way from the middle (or zero) to the bound on that side, over all cells."""
    best = (-1.0, 0, 0, 0.0)
    for tick in range(values.shape[0]):
        for joint in range(values.shape[1]):
            middle = 0.5 * (lower[joint] + upper[joint]) if about_middle else 0.0
            value = values[tick, joint]
            bound = upper[joint] if value >= middle else lower[joint]
            share = abs(value - middle) / abs(bound - middle)
            if share > best[0]:
                best = (share, tick, joint, bound)
    return best


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("alike", [False, True])
def test_limit_use_is_the_largest_share_of_any_joint_at_any_tick(seed: int, alike: bool) -> None:
    rng = np.random.default_rng(seed)
    q, qd, qdd = rng.uniform(-1.0, 1.0, (3, 30, 4))
    bounds = limits(seed)
    if alike:
        # Few values, the same bounds for all: of equal shares the first one counts.
        q, qd, qdd = np.round(q, 1), np.round(qd, 1), np.zeros_like(qdd)
        one = np.ones(4)
        bounds = JointLimits(-one, one, -2 * one, 2 * one, -one, one)
    uses = limit_uses(q, qd, qdd, bounds, NAMES)
    assert [use.kind for use in uses] == ["position", "speed", "acceleration"]
    for use, values in zip(uses, (q, qd, qdd), strict=True):
        lower, upper = bounds.pair(use.kind)
        share, tick, joint, bound = by_brute_force(values, lower, upper, use.kind == "position")
        assert use.share == pytest.approx(share, rel=1e-12), f"seed {seed}"
        assert (use.tick, use.joint, use.bound) == (tick, NAMES[joint], bound)
        assert use.value == values[tick, joint]


def test_kinds_without_limits_are_left_out() -> None:
    bounds = limits(0)
    infinite = np.full(4, np.inf)
    bounds = bounds.with_pair("speed", -infinite, infinite).with_pair("acceleration", -infinite, infinite)
    (use,) = limit_uses(np.zeros((2, 4)), np.zeros((2, 4)), np.zeros((2, 4)), bounds, NAMES)
    assert use.kind == "position"


def test_a_joint_held_by_a_range_of_zero_width_is_not_used_while_it_stands() -> None:
    bounds = limits(1).with_pair("speed", np.array([-1.0, 0, -1, -1]), np.array([1.0, 0, 1, 1]))
    qd = np.zeros((3, 4))
    qd[1, 2] = 0.5
    use = limit_uses(np.zeros((3, 4)), qd, np.zeros((3, 4)), bounds, NAMES)[1]
    assert (use.joint, use.share) == ("j3", 0.5)
    qd[1, 1] = 1e-9
    assert limit_uses(np.zeros((3, 4)), qd, np.zeros((3, 4)), bounds, NAMES)[1].joint == "j2"


@pytest.mark.req("TRF-20")
def test_continuous_joints_have_no_position_limit_to_use() -> None:
    bounds = limits(2)
    lower, upper = bounds.pair("position")
    lower[3], upper[3] = -np.inf, np.inf
    q = np.zeros((2, 4))
    q[1] = 0.05, 0.0, 0.0, 99.0
    use = limit_uses(q, q, q, bounds.with_pair("position", lower, upper), NAMES)[0]
    assert use.joint != "j4"


def tool(position, rotation: Rotation) -> np.ndarray:
    return np.concatenate([position, rotation.as_quat()])


@pytest.mark.req("TRF-11")
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_closure_is_the_worst_joint_of_a_path_that_closes(sign: float) -> None:
    turn = Rotation.from_rotvec([0.3, -0.8, 2.0])
    q = np.array([[0.0, 1.0, 2.0, 3.0], [9.0, 9.0, 9.0, 9.0], [1e-7, 1.0, 2.0 - 3e-4, 3.0]])
    rows = np.array([tool([1.0, 2.0, 3.0], turn)] * 3)
    rows[1, 0] = 7.0
    rows[2, 3:] *= sign
    found = closure(q, rows, NAMES, 1e-6)
    assert found.joint == "j3"
    assert found.difference == pytest.approx(3e-4, rel=1e-9)


@pytest.mark.req("TRF-11")
@pytest.mark.parametrize(("way", "turn", "closes"), [(0.9e-6, 0.0, True), (1.1e-6, 0.0, False)])
def test_a_path_closes_within_the_tolerance_of_the_position(way: float, turn: float, closes: bool) -> None:
    start = Rotation.identity()
    rows = np.array([tool([0.0, 0.0, 0.0], start), tool([way, 0.0, 0.0], start)])
    assert (closure(np.zeros((2, 4)), rows, NAMES, 1e-6) is not None) is closes


@pytest.mark.req("TRF-11")
@pytest.mark.parametrize(("turn", "closes"), [(0.0, True), (0.9e-6, True), (1.1e-6, False), (3.0, False)])
def test_a_path_closes_within_the_tolerance_of_the_orientation(turn: float, closes: bool) -> None:
    start = Rotation.from_rotvec([1.0, 0.0, 0.5])
    end = start * Rotation.from_rotvec([0.0, turn, 0.0])
    rows = np.array([tool([0.0, 0.0, 0.0], start), tool([0.0, 0.0, 0.0], end)])
    assert (closure(np.zeros((2, 4)), rows, NAMES, 1e-6) is not None) is closes


def test_a_single_row_is_no_path() -> None:
    assert closure(np.zeros((1, 4)), np.zeros((1, 7)), NAMES, 1e-6) is None
