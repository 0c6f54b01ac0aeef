"""A robot that waits: so many ticks as the time asks for, and every row is where it stands."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.blocks import Origin, WaitBlock
from irlx.diagnostics import Place
from irlx.motion.whole_ticks import MOST_TICKS
from irlx.pacing.errors import PacingError
from irlx.pacing.waiting import ticks_of_wait, waited
from irlx.robot.kinematics import Kinematics

DT = 0.01
PLACE = Place("t.irl")
pytestmark = pytest.mark.req("LANG-41")


def wait(duration: float) -> WaitBlock:
    return WaitBlock(id=1, origin=Origin("t.irl", 0, 4, 1), duration=duration)


@pytest.mark.parametrize(
    ("duration", "ticks"),
    [(0.0, 0), (0.001, 1), (0.01, 1), (0.0101, 2), (3 * DT, 3), (0.3, 30), (DT * (1.0 + 1e-7), 1)],
)
def test_ticks_that_last_as_long(duration: float, ticks: int) -> None:
    assert ticks_of_wait(duration, DT) == ticks


def test_rows_are_where_the_robot_stands(kit) -> None:
    """As in every motion without a path, the parameter is a share of a whole of 1; it begins at 0."""
    kinematics = Kinematics(kit.gantry())
    rows = waited(wait(0.05), kit.start, DT, 8, kinematics, PLACE)
    assert rows is not None
    assert (len(rows), rows.ticks, rows.first_tick, rows.iterations) == (5, 5, 8, 0)
    assert np.all(rows.q == kit.start)
    np.testing.assert_allclose(rows.tool_position, [kit.position(kit.start)] * 5, rtol=0, atol=1e-15)
    wanted = [kit.rotation(kit.start).as_matrix()] * 5
    np.testing.assert_allclose(rows.tool_rotation, wanted, rtol=0, atol=1e-15)
    assert not np.any(rows.active)
    assert not np.any(rows.path_position_error)
    assert not np.any(rows.path_orientation_error)
    assert (rows.length, not np.any(rows.s)) == (1.0, True)


def test_no_time_is_no_row(kit) -> None:
    assert waited(wait(0.0), kit.start, DT, 1, Kinematics(kit.gantry()), PLACE) is None


@pytest.mark.parametrize("duration", [2.0 * MOST_TICKS * DT, float("inf"), float("nan")])
def test_a_wait_of_too_many_ticks(kit, duration: float) -> None:
    with pytest.raises(PacingError) as caught:
        waited(wait(duration), kit.start, DT, 1, Kinematics(kit.gantry()), PLACE)
    assert caught.value.reason.code == "IRL425"


def test_a_block_by_itself_begins_with_its_only_part(shop) -> None:
    (done,) = shop.pacer.carry_out([WaitBlock(**shop._data(), duration=0.05)])
    assert done.begins
