"""Moves that cannot go on: the message names joint, limit, way, and what is missing."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import LimitKind
from irlx.diagnostics import IrlxError, Place
from irlx.motion.line import Line
from irlx.pacing import impossible
from irlx.pacing.impossible import Surroundings, _explain_standing, explain_broken_row, goal_shortfall
from irlx.pacing.row_check import BrokenBound
from irlx.pacing.slowdown.clock import PlannedClock
from irlx.pacing.slowdown.clock_bounds import Governor
from irlx.pacing.slowdown.curve import JointCurve
from irlx.pacing.slowdown.ladder import TimedCurve
from irlx.robot.kinematics import Kinematics, Sizes
from irlx.transform.nearest import Nearest

pytestmark = pytest.mark.req("MOT-22")


def reason_of(action):
    with pytest.raises(IrlxError) as caught:
        action()
    return caught.value.reason


def test_position_limit_on_the_way_is_named_with_way_and_rest(kit, shop) -> None:
    """y may go to 0.1 m: of 600 mm from -200 mm the line can do 300 mm."""
    shop.switch(LimitKind.POSITION, kit.range([1, 1, 0.1, 1, 1, 1, 1], [-1, -1, -1, -1, -1, -1, -1]))
    reason = reason_of(lambda: shop.line(kit.beyond(0.0, 0.6, 0.0)))
    assert reason.code == "IRL520"
    assert reason.place.line == 2
    assert "y is at its upper position limit 100 mm" in reason.message
    assert reason.data["length"] == "600 mm"
    assert 300.0 <= float(reason.data["way"]) <= 306.0
    assert "target itself is out of reach" in reason.data["missing"]
    assert "leaves 300 mm and" in reason.data["missing"]
    tick = reason.data["tick"]
    assert shop.pacer.tick == 0
    assert tick == pytest.approx((0.3 / 0.5 + 0.5 / 2.0 / 2.0) / shop.dt, abs=2)


@pytest.mark.req("MOT-21")
def test_a_speed_limit_slows_the_tool_and_is_named(kit, shop) -> None:
    """y alone moves the tool along y: 0.4 m/s do not follow 0.5 m/s, so the trapezoid peaks at 0.4 m/s."""
    shop.switch(LimitKind.SPEED, kit.range([1, 1, 0.4, 1, 1, 1, 1]))
    rows = shop.line(kit.beyond(0.0, 0.6, 0.0))
    assert len(rows) * shop.dt == pytest.approx(0.6 / 0.4 + 0.4 / 2.0, abs=3.0 * shop.dt)
    (slowing,) = rows.path.slowings
    assert slowing.joint == 2
    assert slowing.governor.name == "SPEED"
    assert slowing.requested == pytest.approx(0.5)
    assert slowing.achieved == pytest.approx(0.4, rel=1e-2)
    programmed = 0.6 / 0.5 + 0.5 / 2.0
    assert slowing.lost == pytest.approx(0.6 / 0.4 + 0.4 / 2.0 - programmed, abs=2.0 * shop.dt)


@pytest.mark.req("MOT-21")
def test_an_acceleration_limit_slows_a_turn(kit) -> None:
    """The tool turns by joint a alone, which has 0.5 rad/s2: the ramps of the turn follow it."""
    shop = kit.shop(limits=kit.limits(5.0, np.inf, [9.0, 9, 9, 9, 0.5, 9, 9]))
    turn = kit.rotation(kit.moved(0, 0, 0, 0, -0.8, 0, 0))
    rows = shop.line(kit.position(kit.start), turn)
    assert rows.path.planned
    reason = max(rows.path.slowings, key=lambda slowing: slowing.lost)
    assert reason.governor.name == "ACCELERATION"
    peak = np.abs(np.diff(np.vstack([kit.start, kit.start, rows.q]), n=2, axis=0)).max(axis=0) / shop.dt**2
    assert 0.49 < peak[4] <= 0.5 * (1.0 + 1e-9)


def test_both_sides_are_told_apart(kit, shop) -> None:
    shop.switch(LimitKind.POSITION, kit.range([1, 1, 1, 1, 1, 1, 1], [-1, -1, -0.25, -1, -1, -1, -1]))
    reason = reason_of(lambda: shop.line(kit.beyond(0.0, -0.6, 0.0)))
    assert "y is at its lower position limit -250 mm" in reason.message


def test_frozen_joints_are_not_named(kit, shop) -> None:
    """The rail is frozen on its limit; x is what holds the tool back."""
    shop.switch(LimitKind.POSITION, kit.range([0.0, 0.6, 1, 1, 1, 1, 1], [0.0, -1, -1, -1, -1, -1, -1]))
    shop.freeze(1)
    reason = reason_of(lambda: shop.line(kit.beyond(0.3, 0.0, 0.0)))
    assert "x is at its upper position limit 600 mm" in reason.message
    assert "rail" not in reason.message


def test_rows_before_the_failed_move_stay_valid(kit, shop) -> None:
    first = shop.line(kit.beyond(0.1, 0.0, 0.0))
    shop.switch(LimitKind.POSITION, kit.range([1, 1, 0.1, 1, 1, 1, 1], -1.0))
    reason = reason_of(lambda: shop.line(kit.beyond(0.1, 0.6, 0.0)))
    assert reason.data["tick"] > len(first)
    assert shop.pacer.tick == len(first)
    np.testing.assert_array_equal(shop.pacer.q, first.q[-1])
    assert shop.line(kit.position(kit.start)) is not None


def test_way_of_a_line_that_fails_in_its_last_tick_is_in_millimetres(kit) -> None:
    shop = kit.shop(dt=0.05, limits=kit.limits([5, 5, 0.4 - 1e-5, 5, 5, 5, 5]))
    reason = reason_of(lambda: shop.line(kit.beyond(0.0, 0.6, 0.0)))
    assert reason.data["length"] == "600 mm"


def test_turn_is_told_in_degrees(kit, shop) -> None:
    shop.switch(LimitKind.POSITION, kit.range([1, 1, 1, 1, 1, 0.5, 1]))
    q = kit.moved(0, 0, 0, 0, 0, 1.0, 0)
    reason = reason_of(lambda: shop.line(kit.position(q), Rotation.from_euler("ZYX", q[4:7])))
    assert "b is at its upper position limit 28.6479 deg" in reason.message
    assert reason.data["length"] == "57.2958 deg"
    assert 0.7 * 57.2958 <= float(reason.data["way"]) <= 0.72 * 57.2958 + 0.5


def around(kit, limits) -> Surroundings:
    return Surroundings(Kinematics(kit.gantry()), limits, np.ones(7, dtype=bool))


@pytest.mark.parametrize(
    ("joint", "governor", "bound"),
    [
        (2, Governor.SPEED, "y and its speed limit 400 mm/s"),
        (4, Governor.SPEED, f"a and its speed limit {np.degrees(0.5):.6g} deg/s"),
        (2, Governor.ACCELERATION, "y and its acceleration limit 3000 mm/s2"),
        (-1, Governor.SPEED, "the limits together"),
        (2, Governor.PROGRAM, "the limits together"),
    ],
)
def test_a_clock_that_stands_names_the_narrower_side_of_the_joint(kit, joint, governor, bound) -> None:
    """The way is that of the knot; a joint is named only where its own limit makes the clock stand."""
    slow = np.full(7, 0.5)
    limits = kit.limits(5.0, np.inf, 3.0).with_pair("speed", -np.where(np.arange(7) == 2, 0.4, 0.6), slow)
    s = np.array([0.0, 0.2, 0.6])
    q = np.array([kit.moved(0.0, 0.0, way, 0.0, 0.0, 0.0, 0.0) for way in s])
    clock = PlannedClock(s, np.zeros(3), np.full(3, governor, dtype=np.int8), np.full(3, joint))
    timed = TimedCurve(JointCurve(s, q), clock)
    rotation = kit.rotation(kit.start).as_matrix()
    path = Line(kit.beyond(0.0, 0.0, 0.0), rotation, kit.beyond(0.0, 0.6, 0.0), rotation)
    told = _explain_standing(timed, 1, around(kit, limits), path, Place("t.irl"))
    assert told.code == "IRL524"
    assert told.data["bound"] == bound
    assert (told.data["way"], told.data["length"]) == ("200", "600 mm")


def test_a_broken_row_is_told_by_its_tick(kit) -> None:
    """The third row of a motion whose first tick is 8; turns in degrees, slides in mm."""
    found = [
        explain_broken_row(BrokenBound(2, joint, kind, 0.75, 0.5), 8, kit.gantry(), Place("t.irl")).data
        for joint, kind in ((1, LimitKind.SPEED), (4, LimitKind.ACCELERATION), (3, LimitKind.POSITION))
    ]
    assert [data["tick"] for data in found] == [10, 10, 10]
    assert [(data["joint"], data["kind"]) for data in found] == [
        ("x", "speed"),
        ("a", "acceleration"),
        ("z", "position"),
    ]
    assert [data["value"] for data in found] == ["750 mm/s", f"{np.degrees(0.75):.6g} deg/s2", "750 mm"]
    assert [data["bound"] for data in found] == ["500 mm/s", f"{np.degrees(0.5):.6g} deg/s2", "500 mm"]


@pytest.mark.parametrize("first", [(0.0, 0.3), (0.2, 0.0)])
def test_a_goal_is_met_only_in_place_and_in_turn(kit, monkeypatch, first) -> None:
    """A start that ends in the right place but turned, or turned well but elsewhere, is not the last word."""
    sizes = [Sizes(*first, 0.0), Sizes(0.0, 0.0, 0.0), Sizes(9.0, 9.0, 0.0)]
    approaches = iter([Nearest(kit.start, np.zeros(6), size) for size in sizes])
    monkeypatch.setattr(impossible, "nearest_approach", lambda *_: approaches)
    found = goal_shortfall(around(kit, kit.limits()), np.eye(3), np.zeros(3), kit.start, whole=True)
    assert (found.distance, found.angle) == (0.0, 0.0)
    assert len(list(approaches)) == 1


def test_a_tick_whose_pose_is_met_is_not_said_to_miss_nothing(kit) -> None:
    """Its search does not settle, which neither millimetres nor degrees tell."""
    told = impossible._missing(Sizes(3e-10, 0.0, 0.0), None)
    assert told.startswith("at this tick nothing is missing, but the search")
    assert impossible._missing(Sizes(0.0, 2e-9, 0.0), None).startswith(
        "at this tick 0 mm and 1.146e-07 deg are missing;"
    )


def test_no_switch_is_blamed_for_a_band(kit) -> None:
    """Of eight joints the last is a band of WITH TOLERANCE: JOINTLIMIT has narrowed the others alone."""
    freed = SimpleNamespace(joints=np.arange(7))
    switched = {LimitKind.POSITION: "JOINTLIMIT in line 4"}
    found = replace(around(kit, kit.limits()), asked_by=switched, freed=freed)
    assert found.narrowed_by(6, "position") == "JOINTLIMIT in line 4"
    assert found.narrowed_by(7, "position") is None
    assert replace(found, freed=None).narrowed_by(7, "position") == "JOINTLIMIT in line 4"
    assert found.narrowed_by(6, "speed") is None
