"""Time of a line: speeds and accelerations of path and turn are upper bounds, the slower one rules."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.motion.errors import MotionError
from irlx.motion.plan_line import plan_line

pytestmark = pytest.mark.req("MOT-03")


def plan(kit, way, turn=(0.0, 0.0, 0.0), dt: float = 0.01, **law: object):
    rotation = Rotation.from_rotvec([0.2, -0.4, 1.1])
    position = np.array([0.5, -0.25, 1.0])
    goal = None if not np.any(turn) else (rotation * Rotation.from_rotvec(turn)).as_quat()
    block = kit.block(position + np.array(way), goal, kit.law(**law))
    return plan_line(block, block.target, rotation.as_matrix(), position, dt, kit.place)


def peaks(planned, dt: float) -> tuple[float, float, float, float]:
    """Largest speed, acceleration, turn speed and turn acceleration by differences of a fine sampling."""
    times = np.linspace(0.0, planned.ticks * dt, 2001)
    h = times[1]
    poses = planned.path.poses(planned.law.evaluate(times)[0])
    way = np.linalg.norm(poses.position - poses.position[0], axis=1)
    turned = Rotation.from_matrix(poses.rotation[0].T @ poses.rotation).magnitude()
    found = []
    for values in (way, turned):
        rate = np.diff(values) / h
        found += [np.max(np.abs(rate)), np.max(np.abs(np.diff(rate))) / h]
    return tuple(float(value) for value in found)


GOVERNED = {
    "speed": ((2.0, 0.0, 0.0), (0.1, 0.0, 0.0), {}, 0),
    "acc": ((0.1, 0.2, 0.0), (0.0, 0.0, 0.0), {}, 1),
    "turn speed": ((0.5, 0.0, 0.0), (0.0, 2.5, 0.0), {}, 2),
    "turn acc": ((0.01, 0.0, 0.0), (0.0, 0.0, 0.5), {}, 3),
    "turn on the spot": ((0.0, 0.0, 0.0), (0.0, 0.0, 2.0), {"speed": 1e-3}, 2),
    "turn on the spot, short": ((0.0, 0.0, 0.0), (0.0, 0.0, 0.2), {"acc": 1e-3}, 3),
}


@pytest.mark.parametrize(("way", "turn", "law", "governor"), GOVERNED.values(), ids=GOVERNED.keys())
def test_the_slower_of_path_and_turn_governs(kit, way, turn, law: dict, governor: int) -> None:
    dt = 0.0005
    planned = plan(kit, way, turn, dt, **law)
    bounds = np.array([law.get("speed", 1.0), law.get("acc", 2.0), 1.5, 3.0])
    found = np.array(peaks(planned, dt))
    if not np.any(way):
        bounds[:2] = np.inf
    assert np.all(found <= bounds * (1 + 1e-5)), f"{found} against {bounds}"
    # The governor is used up but for the rounding to whole ticks, at most one tick.
    stretch = 1.0 - dt / (planned.ticks * dt)
    assert found[governor] >= bounds[governor] * stretch**2 * (1 - 2e-3)


@pytest.mark.req("MOT-04")
@pytest.mark.parametrize("dt", [0.00025, 0.001, 0.01, 0.05])
def test_duration_is_whole_ticks_and_the_last_pose_the_target(kit, dt: float) -> None:
    planned = plan(kit, (0.4, 0.1, -0.3), (0.0, 1.0, 0.0), dt)
    assert planned.law.duration == pytest.approx(planned.ticks * dt, rel=1e-14)
    # The turn rules: 1 rad at 1.5 rad/s and 3 rad/s2.
    assert planned.ticks == np.ceil((1.0 / 1.5 + 1.5 / 3.0) / dt)
    s, rate = planned.law.evaluate(dt * np.arange(1.0, planned.ticks + 1.0))
    last = planned.path.poses(s)
    np.testing.assert_array_equal(last.position[-1], planned.path.end_position)
    np.testing.assert_array_equal(last.rotation[-1], planned.path.end_rotation)
    assert rate[-1] == 0.0


def test_time_stretches_the_motion(kit) -> None:
    planned = plan(kit, (1.0, 0.0, 0.0), duration=4.0)
    assert planned.ticks == 400
    speed, acc, _, _ = peaks(planned, 0.01)
    fastest = 1.0 / 1.0 + 1.0 / 2.0
    assert speed == pytest.approx(1.0 * fastest / 4.0, rel=1e-6)
    assert acc == pytest.approx(2.0 * (fastest / 4.0) ** 2, rel=1e-2)


def test_time_that_just_fits_is_taken(kit) -> None:
    assert plan(kit, (1.0, 0.0, 0.0), duration=1.5).ticks == 150
    assert plan(kit, (1.0, 0.0, 0.0), duration=1.5 * (1 - 1e-12)).ticks == 150


@pytest.mark.parametrize(
    ("way", "turn", "least", "governor"),
    [
        ((1.0, 0.0, 0.0), (0.0, 0.0, 0.0), 1.5, "SPEED and ACC"),
        ((0.0, 0.0, 0.0), (0.0, 0.0, 1.5), 1.5, "SPEED_ORI and ACC_ORI"),
        ((0.01, 0.0, 0.0), (0.0, 0.0, 1.5), 1.5, "SPEED_ORI and ACC_ORI"),
    ],
)
def test_time_too_short_names_the_governor(kit, way, turn, least: float, governor: str) -> None:
    with pytest.raises(MotionError) as caught:
        plan(kit, way, turn, duration=0.9 * least)
    reason = caught.value.reason
    assert reason.code == "IRL421"
    assert reason.place == kit.place
    assert reason.data["governor"] == governor
    assert float(reason.data["least"]) == pytest.approx(least, rel=1e-5)
    assert float(reason.data["asked"]) == pytest.approx(0.9 * least, rel=1e-5)


def test_governor_of_a_short_motion_is_its_acceleration_alone(kit) -> None:
    """A triangle never reaches the turn's speed bound: ACC of the path is what costs the time."""
    with pytest.raises(MotionError) as caught:
        plan(kit, (0.1, 0.0, 0.0), (0.0, 0.0, 0.3), duration=0.1, speed_ori=2.0, acc=0.5, acc_ori=50.0)
    assert caught.value.reason.data["governor"] == "SPEED and ACC"


@pytest.mark.req("MOT-02")
def test_half_a_turn_is_refused(kit) -> None:
    with pytest.raises(MotionError) as caught:
        plan(kit, (1.0, 0.0, 0.0), (0.0, np.pi, 0.0))
    assert caught.value.reason.code == "IRL422"
    assert caught.value.reason.data["angle"] == "180"
    assert caught.value.reason.place == kit.place


@pytest.mark.req("MOT-01")
@pytest.mark.parametrize("residue", [0.0, 1e-16, 5e-10])
def test_no_way_takes_no_tick(kit, residue: float) -> None:
    assert plan(kit, (residue, 0.0, 0.0)).ticks == 0
    assert plan(kit, (0.0, residue, 0.0), (residue, 0.0, 0.0), duration=3.0).ticks == 0


def test_orientation_is_kept_where_none_is_given(kit) -> None:
    path = plan(kit, (1.0, 0.0, 0.0)).path
    np.testing.assert_array_equal(path.start_rotation, path.end_rotation)
    assert path.turn_rate == 0.0
