"""What an offset of the joints may do in a tick, and how it goes back, against simulated ticks."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.pacing.correction.offset_limiter import OffsetLimiter
from irlx.pacing.correction.plan import PlannedRow
from irlx.pacing.correction.retreat import AT_GOAL, retreat_goal, retreat_step
from irlx.pacing.correction.share import CORRECTION_SHARE, correction_limits, planned_limits
from irlx.robot.limits import JointLimits

DT = 0.01
INF = np.inf


def limits(position=(-INF, INF), speed=(-INF, INF), acceleration=(-INF, INF), n: int = 2) -> JointLimits:
    return JointLimits(*(np.full(n, side) for pair in (position, speed, acceleration) for side in pair))


def row(lowest, highest) -> PlannedRow:
    low, high = np.array(lowest, dtype=float), np.array(highest, dtype=float)
    return PlannedRow(0.5 * (low + high), np.eye(3), np.zeros(3), low, high, None)


def test_a_quarter_of_the_limits_is_kept_for_corrections() -> None:
    """What is planned and what is corrected use the whole together, positions are shared by neither."""
    whole = limits((-2.0, 1.0), (-0.8, 0.4), (-3.0, 6.0))
    planned = planned_limits(whole, 1.0 - CORRECTION_SHARE)
    own = correction_limits(planned)
    for kind in ("speed", "acceleration"):
        for part, of_plan, of_correction in zip(
            whole.pair(kind), planned.pair(kind), own.pair(kind), strict=True
        ):
            np.testing.assert_allclose(of_plan + of_correction, part, rtol=1e-15)
            np.testing.assert_allclose(of_correction, CORRECTION_SHARE * part, rtol=1e-15)
    for each in (planned, own):
        np.testing.assert_array_equal(each.position_lower, whole.position_lower)
        np.testing.assert_array_equal(each.position_upper, whole.position_upper)


def test_positions_bound_what_the_plan_still_reaches() -> None:
    limiter = OffsetLimiter(limits((-1.0, 1.0)), DT)
    bounds = limiter.bounds(np.array([0.1, -0.2]), np.zeros(2), np.array([-0.7, 0.0]), np.array([0.3, 0.5]))
    np.testing.assert_allclose(bounds.lower, [-1.0 + 0.6, -1.0 + 0.2], rtol=0, atol=1e-12)
    np.testing.assert_allclose(bounds.upper, [1.0 - 0.4, 1.0 - 0.3], rtol=0, atol=1e-12)


def test_braking_takes_as_long_as_the_acceleration_says() -> None:
    """0.2 per s at 2 per s2: rest after 0.1 s, half of 0.2 x 0.1 further; the other joint stands still."""
    limiter = OffsetLimiter(limits(acceleration=(-2.0, 2.0)), DT)
    offset, speed, far = np.zeros(2), np.array([0.2, 0.0]), np.zeros(2)
    ticks = 0
    while np.any(speed):
        step = limiter.braked(speed, limiter.bounds(offset, speed, far, far))
        assert np.all(np.abs(step / DT - speed) <= 2.0 * DT * (1 + 1e-9))
        offset, speed, ticks = offset + step, step / DT, ticks + 1
        speed[np.abs(speed) < 1e-12] = 0.0
    assert ticks in (10, 11)
    assert offset[0] == pytest.approx(0.5 * 0.2 * 0.1, abs=0.2 * DT)
    assert offset[1] == 0.0


def test_a_goal_lies_where_the_next_motion_has_room() -> None:
    bounds = limits((-1.0, 1.0))
    there = retreat_goal(np.array([0.3, -0.5]), bounds, row([-0.6, -0.6], [0.9, 0.9]))
    np.testing.assert_allclose(there, [0.1, -0.4], rtol=0, atol=1e-8)
    assert np.all(there < [0.1, 0.0])
    assert there[1] > -0.4
    same = retreat_goal(np.array([0.05, -0.1]), bounds, row([-0.6, -0.6], [0.9, 0.9]))
    np.testing.assert_array_equal(same, [0.05, -0.1])
    # A plan that goes up to the limits itself leaves none at all, and asks for none on the other side.
    np.testing.assert_array_equal(
        retreat_goal(np.array([0.3, -0.2]), bounds, row([-1, -1], [1, 1])), [0.0, 0.0]
    )


@pytest.mark.parametrize(
    ("speed", "acceleration", "fastest", "able"),
    [
        ((-0.3, 0.2), (-1.0, 1.5), 0.2, 1.0),
        ((-INF, INF), (-INF, INF), 0.5, 2.0),
        ((-0.1, 0.3), (-9.0, 0.7), 0.1, 0.7),
    ],
)
def test_an_offset_goes_back_within_its_bounds_and_stays_there(speed, acceleration, fastest, able) -> None:
    """Rest to rest with a trapezoid: way / speed + speed / acceleration, to a few ticks."""
    limiter = OffsetLimiter(limits(speed=speed, acceleration=acceleration), DT)
    goal, offset, now = np.array([0.1, -0.25]), np.array([0.1, 0.05]), np.zeros(2)
    speeds, ticks = [now], 0
    while np.max(np.abs(offset - goal)) > AT_GOAL:
        step = retreat_step(offset, now, goal, limiter)
        offset, now, ticks = offset + step, step / DT, ticks + 1
        speeds.append(now)
        assert ticks < 1000
    rates = np.array(speeds)
    assert np.max(np.abs(rates)) == pytest.approx(fastest, rel=1e-5)
    assert np.max(np.abs(rates)) <= fastest
    assert np.max(np.abs(np.diff(rates, axis=0))) <= able * DT
    assert np.all(rates <= 0.0)
    assert not np.any(rates[:, 0])
    least = 0.3 / fastest + fastest / able
    assert least - 2 * DT <= ticks * DT <= least + 5 * DT
    np.testing.assert_allclose(retreat_step(goal, np.zeros(2), goal, limiter), 0.0)
