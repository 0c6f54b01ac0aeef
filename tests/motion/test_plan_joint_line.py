"""PTP: straight in joint space, all joints together, limits kept by differences of the rows."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.motion.errors import MotionError
from irlx.motion.plan_joint_line import plan_joint_line
from irlx.robot.limits import JointLimits

pytestmark = pytest.mark.req("MOT-05")

TICKS = [0.00025, 0.001, 0.01, 0.05]
NAMES = ("j1", "j2", "j3", "j4")


def limits(speed, acc=np.inf, speed_lower=None, acc_lower=None) -> JointLimits:
    """Limits of four joints; the lower sides mirror the upper ones where they are not given."""
    speed, acc = np.broadcast_to(speed, 4).astype(float), np.broadcast_to(acc, 4).astype(float)
    low = -speed if speed_lower is None else np.broadcast_to(speed_lower, 4).astype(float)
    low_acc = -acc if acc_lower is None else np.broadcast_to(acc_lower, 4).astype(float)
    infinite = np.full(4, np.inf)
    return JointLimits(-infinite, infinite, low, speed, low_acc, acc)


def differences(start: np.ndarray, rows: np.ndarray, dt: float) -> tuple[np.ndarray, np.ndarray]:
    """Speeds and accelerations with rest before the first row and two hold rows after the last."""
    whole = np.vstack([start, start, rows, rows[-1], rows[-1]])
    speeds = np.diff(whole, axis=0) / dt
    return speeds, np.diff(speeds, axis=0) / dt


def random_case(seed: int) -> tuple[np.ndarray, np.ndarray, JointLimits]:
    rng = np.random.default_rng(seed)
    start = rng.uniform(-3.0, 3.0, 4)
    way = rng.uniform(-3.0, 3.0, 4) * rng.choice([0.0, 1e-16, 1e-3, 1.0], size=4)
    way[0] = way[0] or 0.5
    acc = rng.choice([np.inf, 1.0, 30.0], size=4)
    bounds = limits(rng.uniform(0.1, 5.0, 4), acc, -rng.uniform(0.1, 5.0, 4), -rng.choice([0.5, 2.0]) * acc)
    return start, start + way, bounds


@pytest.mark.req("MOT-20")
@pytest.mark.parametrize("dt", TICKS)
@pytest.mark.parametrize("seed", range(15))
def test_rows_keep_speed_and_acceleration_limits(kit, seed: int, dt: float) -> None:
    start, end, bounds = random_case(seed)
    planned = plan_joint_line(start, end, kit.law(), bounds, NAMES, dt, kit.place)
    rows = planned.postures(dt)
    speeds, accelerations = differences(start, rows, dt)
    unit = np.spacing(np.max(np.abs(np.vstack([start, rows]))))
    for values, lower, upper, slack in (
        (speeds, bounds.speed_lower, bounds.speed_upper, 2 * unit / dt),
        (accelerations, bounds.acceleration_lower, bounds.acceleration_upper, 4 * unit / dt**2),
    ):
        assert np.all(values <= upper * (1 + 1e-9) + slack), f"seed {seed}"
        assert np.all(values >= lower * (1 + 1e-9) - slack), f"seed {seed}"
    np.testing.assert_array_equal(rows[-1], end)


@pytest.mark.req("MOT-20")
@pytest.mark.parametrize("excess", [-1e-7, 0.0, 1e-9, 5e-9, 1e-7, 1e-6, 2e-6])
def test_rounding_to_whole_ticks_never_speeds_a_joint_up(kit, excess: float) -> None:
    """Limits for 150 ticks and a little: an excess that does not count as a tick must not break them."""
    slower = 1.0 + excess
    bounds = limits(1.0 / slower, 2.0 / slower**2)
    start, end = np.zeros(4), np.array([1.0, 0.0, 0.0, 0.0])
    planned = plan_joint_line(start, end, kit.law(), bounds, NAMES, 0.01, kit.place)
    assert 150 <= planned.ticks <= 151
    speeds, accelerations = differences(start, planned.postures(0.01), 0.01)
    unit = np.spacing(1.0)
    assert np.max(speeds) <= bounds.speed_upper[0] * (1 + 1e-9) + 2 * unit / 0.01
    assert np.max(np.abs(accelerations)) <= bounds.acceleration_upper[0] * (1 + 1e-9) + 4 * unit / 0.01**2


@pytest.mark.parametrize("seed", range(15))
def test_joints_move_straight_and_arrive_together(kit, seed: int) -> None:
    start, end, bounds = random_case(seed)
    rows = plan_joint_line(start, end, kit.law(), bounds, NAMES, 0.01, kit.place).postures(0.01)
    way = end - start
    share = (rows - start) @ way / (way @ way)
    np.testing.assert_allclose(rows, start + np.outer(share, way), atol=1e-14 * 4, err_msg=f"seed {seed}")
    assert np.all(np.diff(share) >= 0.0)
    still = np.abs(way) == 0.0
    np.testing.assert_array_equal(rows[:, still], np.broadcast_to(start[still], rows[:, still].shape))


def test_the_slowest_joint_rules_and_uses_its_limits(kit) -> None:
    start, end = np.zeros(4), np.array([1.0, -2.0, 0.5, 0.0])
    bounds = limits([1.0, 1.0, 1.0, 1e-6], [2.0, 2.0, 0.4, 1e-6])
    # Joint 2 needs 2 s at 1 rad/s plus a ramp: u' = 0.5 and u'' = min(2, 1, 0.8) = 0.8 rule.
    planned = plan_joint_line(start, end, kit.law(), bounds, NAMES, 0.001, kit.place)
    assert planned.ticks * 0.001 == pytest.approx(1 / 0.5 + 0.5 / 0.8, abs=0.0011)
    speeds, accelerations = differences(start, planned.postures(0.001), 0.001)
    assert np.max(np.abs(speeds[:, 1])) == pytest.approx(1.0, rel=1e-3)
    assert np.max(np.abs(accelerations[:, 2])) == pytest.approx(0.4, rel=1e-3)


@pytest.mark.parametrize(("sign", "seconds"), [(1.0, 1 / 2.0 + 2.0 / 4.0), (-1.0, 1 / 0.5 + 0.5 / 4.0)])
def test_each_direction_has_its_own_speed_limit(kit, sign: float, seconds: float) -> None:
    bounds = limits(2.0, 6.0, speed_lower=-0.5, acc_lower=-4.0)
    end = np.array([sign, 0.0, 0.0, 0.0])
    planned = plan_joint_line(np.zeros(4), end, kit.law(), bounds, NAMES, 0.001, kit.place)
    assert planned.ticks * 0.001 == pytest.approx(seconds, abs=0.0011)


def test_percentages_scale_the_limits(kit) -> None:
    end = np.array([4.0, 0.0, 0.0, 0.0])
    law = kit.law(speed_ptp=0.5, acc_ptp=0.25)
    planned = plan_joint_line(np.zeros(4), end, law, limits(2.0, 4.0), NAMES, 0.001, kit.place)
    assert planned.ticks * 0.001 == pytest.approx(4.0 / 1.0 + 1.0 / 1.0, abs=0.0011)


def test_time_stretches_and_too_little_is_refused(kit) -> None:
    end = np.array([1.0, 0.0, 0.0, 0.0])
    bounds = limits(1.0, 2.0)
    planned = plan_joint_line(np.zeros(4), end, kit.law(duration=3.0), bounds, NAMES, 0.01, kit.place)
    assert planned.ticks == 300
    with pytest.raises(MotionError) as caught:
        plan_joint_line(np.zeros(4), end, kit.law(duration=1.4), bounds, NAMES, 0.01, kit.place)
    assert caught.value.reason.code == "IRL421"
    assert caught.value.reason.place == kit.place
    assert caught.value.reason.data["governor"] == "the joints' limits"
    assert float(caught.value.reason.data["least"]) == pytest.approx(1.5, rel=1e-5)


def test_joints_without_speed_limit_need_time(kit) -> None:
    end = np.array([0.0, 1.0, 0.0, 0.0])
    bounds = limits([1.0, np.inf, 1.0, 1.0])
    with pytest.raises(MotionError) as caught:
        plan_joint_line(np.zeros(4), end, kit.law(), bounds, NAMES, 0.01, kit.place)
    assert caught.value.reason.code == "IRL423"
    assert caught.value.reason.data["joint"] == "j2"
    planned = plan_joint_line(np.zeros(4), end, kit.law(duration=2.0), bounds, NAMES, 0.01, kit.place)
    assert planned.ticks == 200
    np.testing.assert_array_equal(planned.postures(0.01)[-1], end)
    # A quarter of the time each to rise and to fall, 4/3 of the mean rate between.
    way, rate = planned.law.evaluate(np.array([0.25, 0.5, 1.0, 1.5, 2.0]))
    np.testing.assert_allclose(way, [1 / 24, 1 / 6, 1 / 2, 5 / 6, 1.0], rtol=1e-9)
    np.testing.assert_allclose(rate, [1 / 3, 2 / 3, 2 / 3, 2 / 3, 0.0], rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("bounds", [limits(0.0), limits(1.0, 0.0)], ids=["speed", "acceleration"])
def test_a_joint_that_may_not_move_is_a_located_error(kit, bounds: JointLimits) -> None:
    for law in (kit.law(), kit.law(duration=5.0)):
        with pytest.raises(MotionError) as caught:
            plan_joint_line(np.zeros(4), np.array([0.0, 1.0, 1.0, 0.0]), law, bounds, NAMES, 0.01, kit.place)
        assert caught.value.reason.code == "IRL426"
        assert caught.value.reason.data["joint"] == "j2"
        assert caught.value.reason.place == kit.place


@pytest.mark.req("MOT-04")
def test_start_equal_to_goal_takes_no_tick(kit) -> None:
    q = np.array([0.1, -0.2, 0.0, 1e-16])
    planned = plan_joint_line(q, q.copy(), kit.law(), limits(1.0), NAMES, 0.01, kit.place)
    assert planned.ticks == 0
    assert planned.postures(0.01).shape == (0, 4)
    assert planned.law.length == planned.law.duration == planned.law.speed == 0.0


@pytest.mark.req("MOT-04")
@pytest.mark.parametrize("dt", TICKS)
def test_a_way_of_rounding_size_ends_exactly(kit, dt: float) -> None:
    start = np.array([0.5, 0.5, 0.5, 0.5])
    end = np.nextafter(start, 1.0)
    planned = plan_joint_line(start, end, kit.law(), limits(1.0, 10.0), NAMES, dt, kit.place)
    assert planned.ticks == 1
    np.testing.assert_array_equal(planned.postures(dt), end[None])


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_an_acceleration_limit_rules_where_no_speed_limit_is_known(kit, sign: float) -> None:
    """Half the way up, half the way down: 2 sqrt(way / acc), whichever way the joint goes."""
    bounds = limits([np.inf] * 4, [np.inf, 2.0, np.inf, np.inf])
    end = np.array([0.0, sign * 0.5, 0.0, 0.0])
    planned = plan_joint_line(np.zeros(4), end, kit.law(), bounds, NAMES, 1e-4, kit.place)
    assert planned.ticks * 1e-4 == pytest.approx(2.0 * np.sqrt(0.5 / 2.0), abs=3e-4)
