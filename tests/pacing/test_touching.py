"""Flags of the bounds that rows touch, on rows made by hand."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.pacing.touching import touching
from irlx.transform.step_bounds import BoundSource

pytestmark = pytest.mark.req("MOT-21")

DT = 0.01
START = np.zeros(7)
POSITION, SPEED, ACCELERATION = (
    1 + source for source in (BoundSource.POSITION, BoundSource.SPEED, BoundSource.ACCELERATION)
)


def ramp(speed: float, acc: float, rows: int = 60) -> np.ndarray:
    """Joint 3 speeds up by `acc`, then keeps `speed`; every other joint rests."""
    q = np.zeros((rows, 7))
    steps = np.minimum(acc * DT * np.arange(1, rows + 1), speed) * DT
    q[:, 3] = np.cumsum(steps)
    return q


@pytest.mark.parametrize("side", [1, -1])
def test_speed_and_acceleration_are_told_apart_with_their_sides(kit, side: int) -> None:
    q = side * ramp(0.5, 2.0)
    flags = touching(START, q, kit.limits(5.0, 0.5, 2.0), DT)
    speeding = np.arange(60) < 24
    assert np.all(flags[speeding, 3] == side * ACCELERATION)
    assert np.all(flags[25:, 3] == side * SPEED)
    assert not np.any(np.delete(flags, 3, axis=1))


@pytest.mark.parametrize(("share", "touches"), [(0.9985, False), (0.9995, True), (1.0, True)])
def test_a_speed_counts_from_999_thousandths_on(kit, share: float, touches: bool) -> None:
    flags = touching(START, ramp(0.5 * share, 100.0), kit.limits(5.0, 0.5), DT)
    assert np.any(flags[10:, 3] == SPEED) is np.bool_(touches)


@pytest.mark.parametrize(("share", "touches"), [(0.99, False), (0.997, True)])
def test_an_acceleration_counts_from_995_thousandths_on(kit, share: float, touches: bool) -> None:
    flags = touching(START, ramp(9.0, 2.0 * share), kit.limits(50.0, 50.0, 2.0), DT)
    assert np.all(flags[:, 3] == ACCELERATION) is np.bool_(touches)


@pytest.mark.parametrize(("away", "touches"), [(1e-4, True), (3e-4, False), (0.0, True)])
@pytest.mark.parametrize("side", [1, -1])
def test_a_position_counts_within_a_fifth_of_a_milliradian(
    kit, away: float, touches: bool, side: int
) -> None:
    q = np.zeros((9, 7))
    q[:, 2] = side * (1.0 - away) * np.linspace(0.5, 1.0, 9)
    flags = touching(START, q, kit.limits(1.0), DT)
    assert flags[-1, 2] == (side * POSITION if touches else 0)
    assert not np.any(flags[:-2])


def test_position_comes_before_speed(kit) -> None:
    q = ramp(0.5, 100.0)
    flags = touching(START, q, kit.limits(float(q[-1, 3]), 0.5), DT)
    assert flags[-1, 3] == POSITION
    assert flags[20, 3] == SPEED


def test_joints_that_rest_on_their_limits_touch_nothing(kit) -> None:
    start = np.eye(7)[1]
    flags = touching(start, np.tile(start, (9, 1)), kit.limits(1.0, 0.0, 0.0), DT)
    assert not np.any(flags)


def test_nothing_is_touched_without_limits(kit) -> None:
    assert not np.any(touching(START, ramp(0.5, 2.0), kit.limits(np.inf), DT))
