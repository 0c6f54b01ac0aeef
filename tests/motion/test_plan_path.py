"""Time of lines and arcs: speeds and accelerations of path and turn are upper bounds, the slower rules."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.motion.errors import MotionError
from irlx.motion.plan_path import plan_path

pytestmark = pytest.mark.req("MOT-03")


def plan(kit, way, turn=(0.0, 0.0, 0.0), dt: float = 0.01, **law: object):
    rotation = Rotation.from_rotvec([0.2, -0.4, 1.1])
    position = np.array([0.5, -0.25, 1.0])
    goal = None if not np.any(turn) else (rotation * Rotation.from_rotvec(turn)).as_quat()
    block = kit.block(position + np.array(way), goal, kit.law(**law))
    return plan_path(block, rotation.as_matrix(), position, dt, kit.place)


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


# ---- arcs


def plan_arc(kit, radius: float, dt: float = 0.01, turn=None, law=None, **course: object):
    """Plan of a half circle in the x-y plane (or what `course` makes of it) from the origin."""
    turns = (None, None if turn is None else Rotation.from_rotvec(turn).as_quat())
    via, end = radius * np.array([[1.0, 1.0, 0.0], [2.0, 0.0, 0.0]])
    block = kit.circle(via, end, kit.law(**(law or {})), turns, **course)
    return plan_path(block, np.eye(3), np.zeros(3), dt, kit.place)


def arc_peaks(planned, radius: float) -> dict[str, float]:
    """Largest values by differences of a fine sampling: speed, tangential and normal acceleration of the
    path, speed and acceleration of the turn."""
    times = np.linspace(0.0, planned.law.duration, 4001)
    h = times[1]
    poses = planned.path.poses(planned.law.evaluate(times)[0])
    velocity = np.diff(poses.position, axis=0) / h
    speed = np.linalg.norm(velocity, axis=1)
    turning = (
        Rotation.from_matrix(poses.rotation[1:] @ np.swapaxes(poses.rotation[:-1], 1, 2)).as_rotvec() / h
    )
    middle = 0.5 * (poses.position[1:] + poses.position[:-1]) - np.array([radius, 0.0, 0.0])
    inward = -middle / np.linalg.norm(middle, axis=1)[:, None]
    change = np.diff(velocity, axis=0) / h
    return {
        "speed": float(np.max(speed)),
        "along": float(np.max(np.abs(np.diff(speed))) / h),
        "normal": float(np.max(np.abs(np.sum(change * 0.5 * (inward[1:] + inward[:-1]), axis=1)))),
        "turn speed": float(np.max(np.linalg.norm(turning, axis=1))),
        "turn acc": float(np.max(np.linalg.norm(np.diff(turning, axis=0), axis=1)) / h),
    }


ARCS = {
    "speed": (2.0, None, {}, {}, "speed", 1.0),
    "acc along": (2.0, None, {"speed": 50.0, "acc": 0.01}, {"angle": 0.5}, "along", 0.01),
    "acc across": (0.02, None, {}, {"angle": 20.0}, "normal", 2.0),
    "turn speed": (0.2, (0.0, 2.5, 0.0), {}, {}, "turn speed", 1.5),
    "turn acc": (0.01, (0.0, 0.0, 0.5), {"acc": 500.0, "speed": 50.0}, {}, "turn acc", 3.0),
}


@pytest.mark.parametrize(("radius", "turn", "law", "course", "governor", "bound"), ARCS.values(), ids=ARCS)
def test_governors_of_arcs(kit, radius, turn, law, course, governor: str, bound: float) -> None:
    dt = 0.0005
    planned = plan_arc(kit, radius, dt, turn, law, **course)
    found = arc_peaks(planned, radius)
    asked = kit.law(**law)
    bounds = {
        "speed": asked.speed,
        "along": asked.acc,
        "normal": asked.acc,
        "turn speed": asked.speed_ori,
        "turn acc": asked.acc_ori,
    }
    for name, value in found.items():
        assert value <= bounds[name] * (1 + 2e-3), f"{name}: {found}"
    assert found[governor] == pytest.approx(bound, rel=1e-2)


def test_normal_acceleration_alone_bounds_the_speed(kit) -> None:
    """Three rounds of 20 mm radius: sqrt(2 * 0.02) = 0.2 m/s, although SPEED is 1 m/s."""
    planned = plan_arc(kit, 0.02, angle=6 * np.pi)
    way = 0.02 * 6 * np.pi
    fastest = way / 0.2 + 0.2 / 2.0
    assert planned.programmed.duration == pytest.approx(fastest, rel=1e-12)
    assert planned.ticks == np.ceil(fastest / 0.01)


@pytest.mark.req("MOT-02")
def test_turning_through_via_keeps_the_bounds_of_the_turn(kit) -> None:
    turn = Rotation.from_rotvec([0.0, 1.2, 0.0]).as_quat()
    block = kit.circle((0.3, 0.3, 0.0), (0.6, 0.0, 0.0), turns=(turn, None), turns_through_via=True)
    planned = plan_path(block, np.eye(3), np.zeros(3), 0.0005, kit.place)
    found = arc_peaks(planned, 0.3)
    # Position keeps the orientation of the start: there and back by 1.2 rad.
    assert planned.path.angle == pytest.approx(2.4)
    assert found["turn speed"] <= 1.5 * (1 + 1e-6)
    steepest = planned.path.turn_bend * found["speed"] ** 2
    assert steepest <= 3.0 * (1 + 1e-3)
    # Turn along the path and change of the turn's rate are bounded one by one, like ACC on a curve.
    assert found["turn acc"] <= 6.0


def test_time_stretches_an_arc_and_names_the_governor(kit) -> None:
    assert plan_arc(kit, 0.5, law={"duration": 4.0}).ticks == 400
    for turn, governor in ((None, "SPEED and ACC"), ((0.0, 2.5, 0.0), "SPEED_ORI and ACC_ORI")):
        with pytest.raises(MotionError) as caught:
            plan_arc(kit, 0.02, turn=turn, law={"duration": 0.1})
        assert (caught.value.reason.code, caught.value.reason.data["governor"]) == ("IRL421", governor)
    # The normal acceleration governs here: 0.2 m/s on the circle.
    with pytest.raises(MotionError) as caught:
        plan_arc(kit, 0.02, law={"duration": 0.3}, angle=2 * np.pi)
    assert float(caught.value.reason.data["least"]) == pytest.approx(0.02 * 2 * np.pi / 0.2 + 0.1, rel=1e-5)


@pytest.mark.req("MOT-02")
@pytest.mark.parametrize("through", [False, True])
def test_half_a_turn_on_an_arc_is_refused(kit, through: bool) -> None:
    with pytest.raises(MotionError) as caught:
        plan_arc(kit, 0.5, turn=(0.0, np.pi, 0.0), turns_through_via=through)
    assert (caught.value.reason.code, caught.value.reason.data["angle"]) == ("IRL422", "180")


@pytest.mark.req("MOT-02")
def test_a_via_orientation_decides_a_half_turn(kit) -> None:
    turns = [Rotation.from_rotvec([0.0, angle, 0.0]).as_quat() for angle in (0.5 * np.pi, np.pi)]
    block = kit.circle((0.5, 0.5, 0.0), (1.0, 0.0, 0.0), turns=turns, turns_through_via=True)
    assert plan_path(block, np.eye(3), np.zeros(3), 0.01, kit.place).path.end_rotation[0, 0] < -0.999


@pytest.mark.req("MOT-04")
def test_an_arc_ends_on_its_target_in_whole_ticks(kit) -> None:
    planned = plan_arc(kit, 0.37, turn=(0.1, 0.2, 0.3))
    s, rate = planned.law.evaluate(0.01 * np.arange(1.0, planned.ticks + 1.0))
    last = planned.path.poses(s)
    np.testing.assert_array_equal(last.position[-1], [2 * 0.37, 0.0, 0.0])
    np.testing.assert_array_equal(last.rotation[-1], planned.path.end_rotation)
    assert rate[-1] == 0.0


def test_an_arc_beyond_all_numbers_takes_too_long(kit) -> None:
    with pytest.raises(MotionError) as caught:
        plan_arc(kit, 1e300)
    assert caught.value.reason.code == "IRL425"


@pytest.mark.parametrize("law", [{"speed": 1e-120}, {"acc": 1e-120}, {"speed_ori": 1e-120}])
def test_a_speed_of_next_to_nothing_takes_too_long(kit, law: dict[str, float]) -> None:
    with pytest.raises(MotionError) as caught:
        plan(kit, (0.1, 0.0, 0.0), (0.3, 0.0, 0.0), **law)
    assert caught.value.reason.code == "IRL425"
