"""What a dry run says of moves that can be done, on a gantry whose speeds and singular values are known."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.diagnostics import Place
from irlx.pacing.cautions import NEAR_SINGULAR, near_singular, slowed
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
