"""The check by differences finds what is broken, where, and by which joint."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.blocks import LimitKind
from irlx.pacing.row_check import Excess, broken_bound, excess_of

pytestmark = pytest.mark.req("MOT-20")

DT = 0.01
START = np.zeros(7)


def ramp(rows: int = 30, speed: float = 0.1) -> np.ndarray:
    """Rows of joint 2 moving at a speed after one tick, the last row a hold."""
    q = np.zeros((rows, 7))
    q[:, 2] = speed * DT * np.minimum(np.arange(1, rows + 1), rows - 1)
    return q


def test_rows_within_every_bound_are_fine(kit) -> None:
    assert broken_bound(START, ramp(), kit.limits(1.0, 0.1, 10.0), DT) is None
    assert broken_bound(START, np.zeros((3, 7)), kit.limits(0.0, 0.0, 0.0), DT) is None


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("row", [0, 7, 28])
def test_position_beyond_its_limit_by_one_bit_is_found(kit, row: int, side: float) -> None:
    rows = np.zeros((30, 7))
    rows[:, 4] = side
    rows[row, 4] = np.nextafter(side, 2 * side)
    found = broken_bound(np.eye(7)[4] * side, rows, kit.limits(1.0), DT)
    assert (found.row, found.joint, found.kind) == (row, 4, LimitKind.POSITION)
    assert (found.value, found.bound) == (rows[row, 4], side)


@pytest.mark.parametrize("row", [0, 28, 29])
def test_a_value_that_is_no_number_breaks_a_bound(kit, row: int) -> None:
    rows = np.zeros((30, 7))
    rows[row, 4] = np.nan
    assert broken_bound(START, rows, kit.limits(np.inf), DT) is not None


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_speed_is_counted_from_rest_at_the_start(kit, side: float) -> None:
    found = broken_bound(START, side * ramp(speed=0.2), kit.limits(5.0, 0.1), DT)
    assert (found.row, found.joint, found.kind) == (0, 2, LimitKind.SPEED)
    assert found.value == pytest.approx(side * 0.2)
    assert found.bound == side * 0.1


def test_acceleration_into_the_motion_is_found_at_its_first_row(kit) -> None:
    found = broken_bound(START, ramp(speed=0.1), kit.limits(5.0, 1.0, 9.9), DT)
    assert (found.row, found.kind) == (0, LimitKind.ACCELERATION)
    assert found.value == pytest.approx(10.0)


def test_deceleration_into_the_stop_is_found_at_the_hold(kit) -> None:
    """The start is slow enough; the last moving row stops at once, which shows in the hold row."""
    rows = np.zeros((40, 7))
    speed = np.minimum(np.arange(1, 40), 20) * 0.01
    rows[:39, 1] = np.cumsum(speed) * DT
    rows[39] = rows[38]
    found = broken_bound(START, rows, kit.limits(5.0, 1.0, 1.5), DT)
    assert (found.row, found.joint, found.kind) == (39, 1, LimitKind.ACCELERATION)
    assert found.value == pytest.approx(-20.0)
    assert found.bound == -1.5


@pytest.mark.parametrize(("excess", "seen"), [(0.5e-9, False), (3e-9, True)])
def test_relative_excess_above_a_billionth_counts(kit, excess: float, seen: bool) -> None:
    rows = ramp(speed=1.0 + excess)
    assert (broken_bound(START, rows, kit.limits(5.0, 1.0), DT) is not None) is seen


def test_rounding_of_large_values_is_allowed(kit) -> None:
    """At 1e4 rad and 0.25 ms the last bit alone is 29 rad/s2; nothing but it moves here."""
    start = np.full(7, 1e4)
    rows = np.tile(start, (5, 1))
    rows[2] = np.nextafter(rows[2], np.inf)
    assert broken_bound(start, rows, kit.limits(np.inf, 1e-12, 1.0), 0.00025) is None


def test_the_first_broken_row_is_named(kit) -> None:
    rows = np.zeros((20, 7))
    rows[12:, 3] = 0.5
    rows[15, 1] = 7.0
    assert broken_bound(START, rows, kit.limits(5.0), DT).row == 15
    first = broken_bound(START, rows, kit.limits(5.0, 1.0), DT)
    assert (first.row, first.joint, first.kind) == (12, 3, LimitKind.SPEED)


# ---- how far


def test_what_keeps_its_bounds_exceeds_nothing(kit) -> None:
    assert excess_of(START, ramp(), kit.limits(1.0, 0.1, 10.0), DT) == Excess(0.0, 1.0, 1.0, None)


def test_excess_is_told_by_kind(kit) -> None:
    """0.1 per second for 29 ticks, reached and left within one: a fifth of the speed, two accelerations."""
    limits = kit.limits(0.02, 0.5, 5.0)
    found = excess_of(START, ramp(), limits, DT)
    assert found.position == pytest.approx(29 * 0.1 * DT - 0.02)
    assert found.speed == pytest.approx(0.2)
    assert found.acceleration == pytest.approx(2.0)
    assert found.first == broken_bound(START, ramp(), limits, DT)


def test_a_joint_that_rests_takes_nothing_of_a_bound_of_zero(kit) -> None:
    """Nor adds to the share of the others; one that passes it is infinitely beyond."""
    still = np.where(np.arange(7) == 2, 0.5, 0.0)
    found = excess_of(START, ramp(), kit.limits(0.02, still), DT)
    assert found.speed == pytest.approx(0.2)
    moving = np.where(np.arange(7) == 2, 0.0, 0.5)
    assert excess_of(START, ramp(), kit.limits(0.02, moving), DT).speed == np.inf


def test_what_rounding_moves_a_joint_that_may_not_move_is_nothing(kit) -> None:
    """One bit up and down again beside another joint that is twice as fast as it may."""
    limits = kit.limits(5.0, 0.1, 10.0)
    lower, upper = limits.speed_lower.copy(), limits.speed_upper.copy()
    lower[4] = upper[4] = 0.0
    start = np.ones(7)
    rows = start + ramp(speed=0.2)
    rows[10, 4] = np.nextafter(1.0, 2.0)
    found = excess_of(start, rows, limits.with_pair("speed", lower, upper), DT)
    assert found.speed == pytest.approx(2.0, rel=1e-9)
