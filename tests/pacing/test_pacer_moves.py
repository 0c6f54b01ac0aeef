"""Programs of blocks on the gantry against closed forms: rows, holds, limits and options."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import LimitKind, MoveKind
from irlx.pacing.pacer import Pacer
from irlx.pacing.situation import PacingSetup
from irlx.robot.equality import Constraint
from irlx.robot.kinematics import Kinematics
from long_run import first

TICKS = [0.00025, 0.001, 0.01, 0.05]
UP = np.array([0.0, 0.0, 1.0])


def assert_within(rows: np.ndarray, limits, dt: float) -> None:
    """Differences with rest before and after stay in the bounds, plus what float64 storage adds."""
    rest = np.vstack([rows[0], rows[0], rows, rows[-1], rows[-1]])
    unit = np.spacing(np.max(np.abs(rest)))
    speed = np.diff(rest, axis=0) / dt
    acceleration = np.diff(speed, axis=0) / dt
    assert np.all((rest <= limits.position_upper) & (rest >= limits.position_lower))
    for values, kind, slack in (
        (speed, "speed", 2 * unit / dt),
        (acceleration, "acceleration", 4 * unit / dt**2),
    ):
        lower, upper = limits.pair(kind)
        assert np.all(values <= upper * (1 + 1e-9) + slack), kind
        assert np.all(values >= lower * (1 + 1e-9) - slack), kind


@pytest.mark.req("MOT-04")
@pytest.mark.parametrize("dt", TICKS)
def test_every_stop_is_followed_by_a_hold_tick_and_every_end_is_exact(kit, dt: float) -> None:
    shop = kit.shop(dt=dt, limits=kit.limits(5.0, 2.0, 8.0))
    goal = kit.beyond(0.05, 0.02, -0.03)
    rows = shop.line(goal, speed=0.2)
    assert rows.q[-1].tobytes() == rows.q[-2].tobytes()
    np.testing.assert_allclose(kit.position(rows.q[-1]), goal, atol=1e-13)
    assert np.all(rows.active[-1] == 0)
    again = shop.to([0.0, 0.52, -0.2, 0.3, 0.1, -0.2, 0.3])
    assert again.q[-1].tobytes() == again.q[-2].tobytes()
    np.testing.assert_allclose(again.q[-1], [0.0, 0.52, -0.2, 0.3, 0.1, -0.2, 0.3], atol=1e-12)
    assert again.q[-1, :4].tolist() == [0.0, 0.52, -0.2, 0.3]
    assert again.first_tick == len(rows) + 1
    assert shop.pacer.tick == len(rows) + len(again)
    assert_within(shop.all_rows(), shop.limits, dt)


@pytest.mark.req("TRF-02")
def test_least_motion_splits_the_way_by_the_weights(kit, shop) -> None:
    """Rail and x slide along the same line, weights 3 and 1: the rail takes a quarter of every step."""
    start = kit.position(kit.start)
    rows = shop.line(kit.beyond(0.4, 0.1, 0.0))
    way = np.array([kit.position(q) for q in rows.q]) - start
    np.testing.assert_allclose(rows.q[:, 0] - kit.start[0], 0.25 * way[:, 0], atol=1e-12)
    np.testing.assert_allclose(rows.q[:, 1] - kit.start[1], 0.75 * way[:, 0], atol=1e-12)
    np.testing.assert_array_equal(rows.active, 0)


@pytest.mark.req("MOT-20")
def test_tool_follows_line_and_turn_of_the_programmed_law(kit, shop) -> None:
    start, turn = kit.position(kit.start), np.array([0.2, -0.3, 0.5])
    goal = kit.beyond(0.3, -0.2, 0.25)
    rows = shop.line(goal, kit.rotation(kit.start) * Rotation.from_rotvec(turn))
    length = np.linalg.norm(goal - start)
    assert rows.length == pytest.approx(length)
    for q, s in zip(rows.q, rows.s, strict=True):
        np.testing.assert_allclose(kit.position(q), start + s / length * (goal - start), atol=1e-12)
        wanted = kit.rotation(kit.start) * Rotation.from_rotvec(s / length * turn)
        assert (wanted.inv() * kit.rotation(q)).magnitude() < 1e-12
    assert np.all(np.diff(rows.s) >= 0.0)
    speed = np.diff(rows.s, prepend=0.0) / shop.dt
    assert speed.max() <= 0.5 + 1e-12
    assert np.max(np.abs(np.diff(speed, prepend=0.0))) / shop.dt <= 2.0 + 1e-9


@pytest.mark.req("MOT-20")
@pytest.mark.parametrize("dt", first(3, TICKS[::-1]))
def test_position_limit_met_on_the_way_is_kept_exactly(kit, dt: float) -> None:
    """The rail stops at 5 mm, x takes the rest; with accelerations the rail brakes in time."""
    position = np.full(7, 5.0)
    position[0] = 0.005
    for acceleration in (np.inf, 20.0):
        shop = kit.shop(dt=dt, limits=kit.limits(position, 3.0, acceleration))
        goal = kit.beyond(0.04, 0.0, 0.0)
        rows = shop.line(goal, speed=0.25)
        assert_within(shop.all_rows(), shop.limits, dt)
        assert rows.q[:, 0].max() == pytest.approx(0.005, abs=1e-9)
        np.testing.assert_allclose(kit.position(rows.q[-1]), goal, atol=1e-12)
        held = rows.active[:, 0]
        assert np.any(held > 0)
        assert set(np.unique(held)) <= ({0, 1} if acceleration == np.inf else {0, 1, 3, -3, 4})


@pytest.mark.req("MOT-20")
def test_speed_limit_of_one_joint_lets_the_other_take_over(kit, shop) -> None:
    shop.switch(LimitKind.SPEED, kit.range([0.05, 5, 5, 5, 5, 5, 5]))
    rows = shop.line(kit.beyond(0.5, 0.0, 0.0))
    speed = np.diff(rows.q[:, 0], prepend=0.0) / shop.dt
    assert speed.max() <= 0.05 * (1 + 1e-9)
    assert speed.max() == pytest.approx(0.05, rel=1e-5)
    assert np.all(rows.active[np.flatnonzero(speed > 0.0499), 0] == 2)
    shop.switch(LimitKind.SPEED, None)
    back = shop.line(kit.position(kit.start))
    assert np.max(np.abs(np.diff(back.q[:, 0]))) / shop.dt == pytest.approx(0.125, rel=1e-2)


@pytest.mark.req("TRF-12")
def test_frozen_joints_keep_every_bit_until_freed(kit, shop) -> None:
    start = kit.position(kit.start)
    shop.freeze(1)
    rows = shop.line(
        kit.beyond(0.4, 0.1, 0.2), kit.rotation(kit.start) * Rotation.from_rotvec([0.1, 0.2, 0.3])
    )
    assert np.all(rows.q[:, 0] == kit.start[0])
    np.testing.assert_allclose(rows.q[-1, 1], kit.start[1] + 0.4, atol=1e-12)
    shop.freeze()
    assert shop.line(start).q[-1, 0] != kit.start[0]


@pytest.mark.req("TRF-11")
def test_cyclic_option_returns_the_posture_least_motion_does_not(kit) -> None:
    """A detour with the rail limited: without the option it stays displaced, with it it comes home."""
    ends = []
    for cyclic in (False, True):
        shop = kit.shop()
        start = kit.position(kit.start)
        if cyclic:
            shop.cyclic()
        clause = shop.clause(LimitKind.SPEED, kit.range([0.01, 5, 5, 5, 5, 5, 5]), 3)
        shop.line(kit.beyond(0.4, 0.0, 0.0), clauses=[clause])
        ends.append(shop.line(start).q[-1])
    assert abs(ends[0][0] - kit.start[0]) > 0.05
    np.testing.assert_allclose(ends[1], kit.start, atol=1e-9)


@pytest.mark.req("MOT-05")
def test_ptp_to_a_pose_takes_the_nearest_posture(kit) -> None:
    """Weights 3 and 1 split the way along x one to three, as the weighted norm asks."""
    shop = kit.shop(limits=kit.limits(5.0, 2.0, 8.0))
    goal = kit.beyond(0.4, 0.1, 0.1)
    rows = shop.ptp_pose(goal, kit.rotation(kit.moved(0, 0, 0, 0, 0.3, 0.1, -0.2)))
    wanted = kit.moved(0.1, 0.3, 0.1, 0.1, 0.3, 0.1, -0.2)
    np.testing.assert_allclose(rows.q[-1], wanted, atol=1e-8)
    assert_within(shop.all_rows(), shop.limits, shop.dt)


@pytest.mark.req("LANG-69")
def test_line_to_a_posture_reaches_it_on_a_straight_tool_path(kit, shop) -> None:
    goal = kit.moved(0.3, -0.1, 0.1, -0.1, 0.2, 0.1, -0.1)
    rows = shop.to(goal, MoveKind.LIN)
    np.testing.assert_allclose(rows.q[-1], goal, atol=1e-9)
    start, end = kit.position(kit.start), kit.position(goal)
    direction = (end - start) / np.linalg.norm(end - start)
    way = np.array([kit.position(q) for q in rows.q]) - start
    assert np.max(np.abs(way - np.outer(way @ direction, direction))) < 1e-12
    assert shop.pacer.warnings == []


@pytest.mark.req("LANG-69")
def test_line_to_a_posture_that_is_held_back_warns_of_what_is_left(kit, shop) -> None:
    shop.freeze(1)
    rows = shop.to(kit.moved(0.3, -0.1, 0.1, 0, 0, 0, 0), MoveKind.LIN)
    np.testing.assert_allclose(rows.q[-1, :2], [0.0, 0.7], atol=1e-9)
    (warning,) = shop.pacer.warnings
    assert warning.code == "IRL348"
    assert warning.data["joint"] in ("rail", "x")
    assert warning.data["difference"] == "300 mm"
    assert warning.place.line == 2


@pytest.mark.req("MOT-01")
def test_moves_of_no_length_take_no_tick(kit, shop) -> None:
    assert shop.line(kit.position(kit.start)) is None
    assert shop.to(kit.start) is None
    assert shop.to(kit.start, MoveKind.LIN) is None
    assert shop.pacer.tick == 0


def test_demand_modifiers_change_what_is_followed(kit) -> None:
    """Called once a tick, one after another; the errors are judged against the changed demand."""
    seen = []

    def lift(demand):
        seen.append(demand.tick)
        return demand._replace(position=demand.position + 0.01 * min(demand.s / 0.2, 1.0) * UP)

    def record(demand):
        assert demand.position[2] >= 0.3
        return demand

    shop = kit.shop(modifiers=(lift, record))
    rows = shop.line(kit.beyond(0.2, 0.0, 0.0))
    assert seen == list(range(1, len(rows)))
    assert rows.q[-1, 3] == pytest.approx(0.31, abs=1e-12)
    assert rows.path_position_error.max() < 1e-10


def test_same_blocks_give_the_same_bytes(kit) -> None:
    found = []
    for _ in range(2):
        shop = kit.shop(limits=kit.limits([0.05, 5, 5, 5, 5, 5, 5], 2.0, 8.0))
        shop.line(kit.beyond(0.3, 0.1, 0.0), speed=0.2)
        shop.ptp_pose(kit.position(kit.start), kit.rotation(kit.start))
        found.append(shop.all_rows().tobytes())
    assert found[0] == found[1]


class Stays(Constraint):
    """One joint is where it is at the start."""

    def __init__(self, joint: int, value: float) -> None:
        self.name, self._joint, self._value = f"joint {joint} stays", joint, value

    def residual(self, q: np.ndarray) -> np.ndarray:
        return q[self._joint : self._joint + 1] - self._value

    def derivative(self, q: np.ndarray) -> np.ndarray:
        return np.eye(q.size)[self._joint : self._joint + 1]


@pytest.mark.parametrize("joint", [0, 3, 6])
def test_a_frozen_joint_breaks_no_condition_of_its_own(kit, joint: int) -> None:
    """Frozen, it keeps the condition by itself: that goes, and comes back with the joint."""
    stays = Stays(joint, kit.start[joint])
    kinematics = Kinematics(kit.gantry()).constrained([stays])
    shop = kit.shop()
    setup = PacingSetup(kinematics, shop.limits, np.ones(7), kit.start, shop.dt, may_free=True)
    shop.pacer = Pacer(setup, shop.pacer.locate)
    other = (joint + 1) % 7
    for frozen, left in (((joint + 1,), ()), ((other + 1,), (stays,)), ((), (stays,))):
        shop.freeze(*frozen)
        assert shop.pacer.setup.kinematics.constraints == left
