"""Slowed stretches of clocks made by hand: where, how much, whose limit, and the time they cost."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.motion.trapezoid import Trapezoid
from irlx.pacing.slowdown.clock import PlannedClock
from irlx.pacing.slowdown.clock_bounds import PATH, Governor
from irlx.pacing.slowing import slowings, told_in_ticks

pytestmark = pytest.mark.req("MOT-21")

LAW = Trapezoid.fastest(1.0, 0.5, 1.0)
S = np.concatenate(
    [np.linspace(0, 0.125, 51), np.linspace(0.125, 0.875, 301)[1:], np.linspace(0.875, 1, 51)[1:]]
)
RATES = LAW.rates_at(S)


def clock(*dips: tuple[float, float, float, Governor, int]) -> PlannedClock:
    """The programmed clock with rates multiplied between two ways, for a governor and joint."""
    rates = RATES.copy()
    governor, joint = np.zeros(S.size, dtype=np.int8), np.full(S.size, PATH, dtype=np.int16)
    for first, last, share, why, who in dips:
        inside = (first <= S) & (last >= S)
        rates[inside] *= share
        governor[inside], joint[inside] = why, who
    return PlannedClock(S, rates**2, governor, joint)


def test_a_clock_as_programmed_has_none() -> None:
    assert slowings(clock(), RATES, 1.0, 0.01, 250) == ()
    assert slowings(clock((0.4, 0.6, 0.9995, Governor.SPEED, 2)), RATES, 1.0, 0.01, 250) == ()


def test_a_dip_is_told_with_its_place_joint_and_figures() -> None:
    planned = clock((0.4, 0.6, 0.5, Governor.SPEED, 2))
    (found,) = slowings(planned, RATES, 1.0, 0.01, 400)
    assert (found.governor, found.joint) == (Governor.SPEED, 2)
    assert 0.4 - 1e-9 <= found.s <= 0.6 + 1e-9
    assert (found.requested, found.achieved) == pytest.approx((0.5, 0.25), rel=1e-9)
    assert found.lost == pytest.approx(planned.duration - LAW.duration, rel=1e-9)
    times = planned.times[[np.argmin(np.abs(S - way)) for way in (0.4, 0.6)]]
    assert [found.first_row, found.last_row] == pytest.approx(times / 0.01 - 1.0, abs=1.0)


def test_lost_time_of_several_stretches_is_the_difference_of_durations() -> None:
    dips = [
        (0.2, 0.3, 0.5, Governor.SPEED, 0),
        (0.5, 0.52, 0.8, Governor.ACCELERATION, 3),
        (0.9, 0.95, 0.7, 1, 6),
    ]
    planned = clock(*dips)
    found = slowings(planned, RATES, 1.0, 0.01, 400)
    assert [(part.governor, part.joint) for part in found] == [(1, 0), (2, 3), (1, 6)]
    assert sum(part.lost for part in found) == pytest.approx(planned.duration - LAW.duration, rel=1e-9)
    rows = [row for part in found for row in (part.first_row, part.last_row)]
    assert rows == sorted(rows)


def test_stretches_with_one_knot_between_share_no_time() -> None:
    first, last = S[120], S[140]
    planned = clock((S[100], first, 0.5, Governor.SPEED, 0), (S[122], last, 0.5, Governor.SPEED, 1))
    found = slowings(planned, RATES, 1.0, 0.01, 400)
    assert len(found) == 2
    assert sum(part.lost for part in found) == pytest.approx(planned.duration - LAW.duration, rel=1e-9)


def test_a_slower_replay_slows_what_is_told() -> None:
    planned = clock((0.4, 0.6, 0.5, Governor.SPEED, 2))
    (found,) = slowings(planned, RATES, 1.25, 0.01, 500)
    assert found.achieved == pytest.approx(0.2, rel=1e-9)
    (plain,) = slowings(planned, RATES, 1.0, 0.01, 500)
    assert found.lost > plain.lost
    assert found.last_row == pytest.approx(1.25 * plain.last_row, abs=2)


def test_rows_stay_within_the_motion() -> None:
    planned = clock((0.0, 1.0, 0.5, Governor.SPEED, 4))
    (found,) = slowings(planned, RATES, 1.0, 0.05, 20)
    assert 0 <= found.first_row <= 2
    assert found.last_row == 19


def test_the_path_is_named_only_where_no_joint_is() -> None:
    """A stretch that is slow in part without a joint to blame names the joint of the rest."""
    planned = clock((0.4, 0.5, 0.4, Governor.PROGRAM, PATH), (0.5, 0.6, 0.6, Governor.ACCELERATION, 1))
    (found,) = slowings(planned, RATES, 1.0, 0.01, 400)
    assert found.joint == 1
    (alone,) = slowings(clock((0.4, 0.5, 0.4, Governor.PROGRAM, PATH)), RATES, 1.0, 0.01, 400)
    assert (alone.joint, alone.governor) == (PATH, Governor.PROGRAM)


def test_in_whole_ticks_the_time_told_is_that_by_which_the_motion_is_longer() -> None:
    planned = clock((0.2, 0.3, 0.5, Governor.SPEED, 0), (0.6, 0.7, 0.8, Governor.SPEED, 3))
    found = slowings(planned, RATES, 1.0, 0.01, 400)
    told = told_in_ticks(found, 0.3)
    assert sum(part.lost for part in told) == pytest.approx(0.3, rel=1e-12)
    assert told[0].lost / told[1].lost == pytest.approx(found[0].lost / found[1].lost, rel=1e-12)
    assert [(part.s, part.joint) for part in told] == [(part.s, part.joint) for part in found]


@pytest.mark.parametrize("later", [0.0, -0.01])
def test_a_motion_that_takes_no_longer_is_not_slowed(later: float) -> None:
    found = slowings(clock((0.4, 0.41, 0.99, Governor.SPEED, 2)), RATES, 1.0, 0.01, 251)
    assert len(found) == 1
    assert told_in_ticks(found, later) == ()
    assert told_in_ticks((), 0.1) == ()
