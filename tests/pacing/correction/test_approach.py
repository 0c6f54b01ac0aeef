"""The way of a correction to its request: straight, within its bounds, and there to the last bit."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.pacing.correction.approach import TOOL, Governor, Pace, approach
from irlx.pacing.correction.tool_rates import ToolRates
from irlx.robot.limits import JointLimits
from irlx.transform.step_bounds import BoundSource

DT = 0.01
RATES = ToolRates(0.3, 1.5, 0.6, 2.5)


def limits(speed, acceleration, slowest=None, hardest=None) -> JointLimits:
    """Of as many joints as there are speeds; lower sides mirrored where they are not given."""
    v, a = (np.array(values, dtype=float) for values in (speed, acceleration))
    lower_v, lower_a = (
        -v if slowest is None else np.array(slowest),
        -a if hardest is None else np.array(hardest),
    )
    endless = np.full(v.size, np.inf)
    return JointLimits(-endless, endless, lower_v, v, lower_a, a)


def run(pace: Pace, request: np.ndarray, ticks: int = 400) -> tuple[np.ndarray, list[Governor]]:
    """Corrections of all ticks until the request has been reached and nothing moves, the start first."""
    at, rate, found, governors = np.zeros(6), np.zeros(6), [np.zeros(6)], []
    for _ in range(ticks):
        at, rate, governor = approach(at, rate, request, pace, DT)
        found.append(at)
        governors.append(governor)
        if np.array_equal(at, request) and not np.any(rate):
            return np.array(found), governors
    raise AssertionError("never there")


FREE = Pace(np.zeros((2, 6)), limits([1.0, 1.0], [1.0, 1.0]), RATES)
"""Joints that a correction costs nothing: the tool's own rates decide."""


@pytest.mark.parametrize(("row", "speed", "acceleration"), [(1, 0.3, 1.5), (5, 0.6, 2.5)])
def test_the_rates_of_the_tool_are_used_and_kept(row: int, speed: float, acceleration: float) -> None:
    request = np.zeros(6)
    request[row] = -0.4
    way, governors = run(FREE, request)
    rates = np.diff(way[:, row], prepend=0.0) / DT
    assert -np.min(rates) == pytest.approx(speed, rel=1e-12)
    assert np.max(rates) < 1e-12
    changes = np.diff(rates) / DT
    assert np.max(np.abs(changes)) == pytest.approx(acceleration, rel=1e-9)
    assert not np.any(np.delete(way, row, axis=1))
    assert governors[0] == Governor(TOOL, BoundSource.ACCELERATION)
    assert governors[len(governors) // 2] == Governor(TOOL, BoundSource.SPEED)
    # Rest to rest at such a speed, braking with 0.8 of the acceleration, a few ticks of rounding up.
    least = 0.4 / speed + 0.5 * speed / acceleration * (1.0 + 1.0 / 0.8)
    assert least <= len(governors) * DT <= least + 6 * DT


def test_half_of_what_the_joints_have_is_taken() -> None:
    """Joint 2 turns by 4 rad a metre along x; backwards its speed limit is another one."""
    costs = np.zeros((2, 6))
    costs[0, 0], costs[1, 0] = 1.0, 4.0
    pace = Pace(
        costs, limits([10.0, 0.8], [50.0, 4.0], [-10.0, -0.4], [-50.0, -6.0]), ToolRates(9, 99, 9, 99)
    )
    ahead, back = np.eye(6)[0], -np.eye(6)[0]
    assert pace.speed(ahead) == (pytest.approx(0.5 * 0.8 / 4.0), Governor(1, BoundSource.SPEED))
    assert pace.speed(back) == (pytest.approx(0.5 * 0.4 / 4.0), Governor(1, BoundSource.SPEED))
    for direction in (ahead, back):
        assert pace.acceleration(direction) == (
            pytest.approx(0.5 * 4.0 / 4.0),
            Governor(1, BoundSource.ACCELERATION),
        )
    assert pace.speed(np.eye(6)[1]) == (9.0, Governor(TOOL, BoundSource.SPEED))


def test_a_slanting_way_is_straight_and_keeps_both_rates() -> None:
    request = np.array([0.2, 0.1, -0.1, 0.3, 0.0, 0.4])
    way, _ = run(FREE, request)
    shares = way @ request / (request @ request)
    np.testing.assert_allclose(way, shares[:, None] * request, rtol=0, atol=1e-14)
    assert np.all(np.diff(shares) >= 0.0)
    rates = np.diff(way, axis=0) / DT
    assert np.max(np.linalg.norm(rates[:, :3], axis=1)) <= RATES.speed * (1 + 1e-12)
    assert np.max(np.linalg.norm(rates[:, 3:], axis=1)) <= RATES.speed_ori * (1 + 1e-12)


@pytest.mark.parametrize("size", [1e-12, 1e-5, 0.01, 0.3])
def test_no_overshoot_however_near_the_request_is(size: float) -> None:
    request = size * np.array([0.6, 0.0, 0.8, 0.0, 0.0, 0.0])
    way, _ = run(FREE, request)
    along = way @ request / size
    assert np.max(along) <= size * (1 + 1e-12)
    np.testing.assert_array_equal(way[-1], request)


def test_a_request_that_turns_round_is_braked_for() -> None:
    """Underway at full speed the other way: the rate changes by no more than the acceleration allows."""
    at, rate, request = np.zeros(6), 0.3 * np.eye(6)[0], -0.05 * np.eye(6)[0]
    found, rates = [at], [rate]
    for _ in range(200):
        at, rate, _ = approach(at, rate, request, FREE, DT)
        found.append(at)
        rates.append(rate)
    assert np.max(np.abs(np.diff(rates, axis=0))) / DT <= 1.5 * (1 + 1e-9)
    np.testing.assert_array_equal(found[-1], request)
    assert not np.any(rates[-1])
