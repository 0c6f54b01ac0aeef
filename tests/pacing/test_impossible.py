"""Moves that cannot go on: the message names joint, limit, way, and what is missing."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import LimitKind
from irlx.diagnostics import IrlxError

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
