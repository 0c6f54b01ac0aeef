"""What a dry run says of moves that can be done, on a gantry whose speeds and singular values are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from irlx.blocks import Origin
from irlx.diagnostics import Place
from irlx.diagnostics.digits import plain
from irlx.pacing.cautions import NEAR_SINGULAR, near_singular, slowed
from irlx.pacing.rows import handed_out
from irlx.report.events import slowed_events
from irlx.robot.kinematics import Kinematics

PLACE = Place("t.irl")
SLIDE, TURN = 2, 4


def one_slow_joint(joint: int, bound: float) -> np.ndarray:
    speed = np.full(7, np.inf)
    speed[joint] = bound
    return speed


def test_a_line_that_one_slide_makes_slow(kit) -> None:
    """0.6 m at 0.4 m/s instead of 0.5 m/s with ramps of 2 m/s2: 0.6 / 0.4 + 0.2 s instead of 1.45 s."""
    shop = kit.shop(limits=kit.limits(5.0, one_slow_joint(SLIDE, 0.4)))
    rows = shop.line(kit.beyond(0.0, 0.6, 0.0))
    found = slowed(rows, Kinematics(kit.gantry()), shop.limits, shop.dt, PLACE)
    assert found is not None
    data = found.finding.data
    assert found.finding.code == "IRL445"
    assert found.weight == pytest.approx(0.25 / 1.45, rel=0.1)
    assert float(data["lost"]) == pytest.approx(0.25, abs=2.0 * shop.dt)
    assert data["held"] == "y and its speed limit 400 mm/s"
    assert float(data["achieved"]) == pytest.approx(400.0, rel=1e-2)
    assert (data["requested"], data["length"]) == ("500 mm/s", "600 mm")


def test_a_stretch_over_joined_moves_is_told_of_what_those_should_take(kit) -> None:
    """The line of the test above as three moves, the middle one 1 mm of it: its own time is no measure.

    What is slow, from 0.04 m to 0.56 m, should take 1.05 s of the 1.45 s.
    """
    shop = kit.shop(limits=kit.limits(5.0, one_slow_joint(SLIDE, 0.4)))
    rows = shop.line(kit.beyond(0.0, 0.6, 0.0))
    (stretch,) = rows.path.slowings
    worst = replace(rows.path, slowings=(replace(stretch, s=0.3005),))
    blocks = [replace(rows.block, origin=Origin("t.irl", 0, 1, line)) for line in (7, 8, 9)]
    parts = handed_out(replace(rows, path=worst), blocks, (0.3, 0.301, 0.6))
    assert parts[1] is not None
    found = slowed(parts[1], Kinematics(kit.gantry()), shop.limits, shop.dt, PLACE)
    assert found is not None
    assert found.weight == pytest.approx(0.25 / 1.05, rel=0.1)
    assert found.finding.data["share"] == f"{100.0 * found.weight:.0f}"
    assert "make the joined moves (lines 7 to 9) 0.2" in found.finding.message
    assert ": at 0.5 of 1 mm of this one the tool" in found.finding.message
    (event,) = slowed_events(parts[1], shop.limits, [f"j{k}" for k in range(7)], shop.dt)
    assert (event.line, event.first_line, event.last_line) == (8, 7, 9)


@pytest.mark.parametrize(("value", "words"), [(0.034, "0.034"), (9.87, "9.9"), (11.2, "11"), (26e3, "26000")])
def test_shares_are_told_in_plain_digits(value: float, words: str) -> None:
    assert plain(value, 2) == words


def test_a_turn_that_one_joint_makes_slow_to_start(kit) -> None:
    """Joint a alone turns the tool and has 0.5 rad/s2 instead of the 4 that are asked for."""
    shop = kit.shop(limits=kit.limits(5.0, np.inf, one_slow_joint(TURN, 0.5)))
    turn = kit.rotation(kit.moved(0, 0, 0, 0, -0.8, 0, 0))
    rows = shop.line(kit.position(kit.start), turn)
    found = slowed(rows, Kinematics(kit.gantry()), shop.limits, shop.dt, PLACE)
    assert found is not None
    data = found.finding.data
    assert data["held"] == f"a and its acceleration limit {np.degrees(0.5):.6g} deg/s2"
    assert data["requested"].endswith(" deg/s")
    assert data["length"] == f"{np.degrees(0.8):.4g} deg"


def test_nothing_is_said_of_what_is_as_fast_as_programmed(kit, shop) -> None:
    kinematics = Kinematics(kit.gantry())
    rows = shop.line(kit.beyond(0.0, 0.3, 0.0))
    assert slowed(rows, kinematics, shop.limits, shop.dt, PLACE) is None
    assert near_singular(rows, kinematics, PLACE) is None
    joints = shop.to(kit.moved(0.1, 0, 0, 0, 0, 0, 0), duration=0.5)
    assert slowed(joints, kinematics, shop.limits, shop.dt, PLACE) is None
    assert near_singular(joints, kinematics, PLACE) is None


@pytest.mark.parametrize(("from_pole", "near"), [(0.01, True), (0.2, False)])
def test_turns_about_axes_that_nearly_fall_together(kit, from_pole: float, near: bool) -> None:
    """With b near a right angle axes z and x nearly coincide: the least singular value is sqrt(1 - sin b)."""
    start = kit.start.copy()
    start[5] = 0.5 * np.pi - from_pole
    shop = kit.shop(start=start)
    rows = shop.line(kit.position(start) + np.array([0.1, 0.0, 0.0]))
    kinematics = Kinematics(kit.gantry())
    found = near_singular(rows, kinematics, PLACE)
    scale = kinematics.row_scale[0]
    least, most = (
        np.sqrt(1.0 - np.cos(from_pole)),
        max(np.sqrt(1.0 + np.cos(from_pole)), scale * np.sqrt(2.0)),
    )
    assert bool(least / most < NEAR_SINGULAR) is near
    if not near:
        assert found is None
        return
    assert found is not None
    assert found.finding.code == "IRL446"
    assert found.weight == pytest.approx(-least / most, rel=1e-6)
    assert float(found.finding.data["sigma"]) == pytest.approx(least, rel=0.05)
    assert float(found.finding.data["share"]) == pytest.approx(100.0 * least / most, rel=0.05)
    assert found.finding.data["length"] == "100 mm"
