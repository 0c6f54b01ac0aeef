"""Checks rows by differences before they are emitted: the same figures a verifier will compute."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import LimitKind
from irlx.pacing.resolution import ticks_before
from irlx.promises import LIMIT_EXCESS, rounding_allowance
from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]


@dataclass(frozen=True)
class BrokenBound:
    """First row (counted from 0) at which a joint (from 0) passes a bound: found and allowed value."""

    row: int
    joint: int
    kind: LimitKind
    value: float
    bound: float

    def counted_in_ticks(self, ticks_a_row: float) -> BrokenBound:
        """The same with `row` as the number of its tick, where a row stands for more than one of them."""
        return replace(self, row=ticks_before(self.row, ticks_a_row))


def broken_bound(start: Array, rows: Array, limits: JointLimits, dt: float) -> BrokenBound | None:
    """First bound that rows (N, n) after rest at `start` (n,) break, or None.

    Speeds and accelerations are backward differences; the last row must be a hold, so that the
    deceleration into the stop is judged too.
    """
    return broken_on_the_way(np.vstack([start, start, rows]), limits, dt)


def broken_on_the_way(rows: Array, limits: JointLimits, dt: float) -> BrokenBound | None:
    """First bound that rows (N + 2, n) break which follow the two first of them, however these move, or None.

    `BrokenBound.row` counts from the third row.
    """
    speeds = np.diff(rows, axis=0) / dt
    accelerations = np.diff(speeds, axis=0) / dt
    speed_slack, acceleration_slack = rounding_allowance(rows, dt)
    found = [
        _first(LimitKind.POSITION, rows[2:], limits.position_lower, limits.position_upper, 0.0, 0.0),
        _first(
            LimitKind.SPEED, speeds[1:], limits.speed_lower, limits.speed_upper, LIMIT_EXCESS, speed_slack
        ),
        _first(
            LimitKind.ACCELERATION,
            accelerations,
            limits.acceleration_lower,
            limits.acceleration_upper,
            LIMIT_EXCESS,
            acceleration_slack,
        ),
    ]
    return min((bound for bound in found if bound), key=lambda bound: bound.row, default=None)


def _first(
    kind: LimitKind, values: Array, lower: Array, upper: Array, relative: float, absolute: float
) -> BrokenBound | None:
    highest = upper * (1.0 + relative) + absolute if relative else upper
    lowest = lower * (1.0 + relative) - absolute if relative else lower
    # Written so that what is no number breaks its bound.
    over, under = ~(values <= highest), ~(values >= lowest)
    broken = over | under
    if not np.any(broken):
        return None
    row, joint = (int(index) for index in np.argwhere(broken)[0])
    bound = upper[joint] if over[row, joint] else lower[joint]
    return BrokenBound(row, joint, kind, float(values[row, joint]), float(bound))


@dataclass(frozen=True)
class Excess:
    """How far rows pass their bounds: position by rad or m (0: not at all), speed and acceleration as a
    share of the bound (at most 1: kept); `first` is the first bound that is broken, None where none is."""

    position: float
    speed: float
    acceleration: float
    first: BrokenBound | None


def excess_of(start: Array, rows: Array, limits: JointLimits, dt: float) -> Excess:
    """Excess of rows (N, n) after rest at `start` (n,), their last one a hold, by differences.

    A bound kept but for rounding (`broken_bound` finds nothing) counts as kept: its share is 1.
    """
    broken = broken_bound(start, rows, limits, dt)
    if broken is None:
        return Excess(0.0, 1.0, 1.0, None)
    rest = np.vstack([start, start, rows])
    speeds = np.diff(rest, axis=0) / dt
    accelerations = np.diff(speeds, axis=0) / dt
    slack = rounding_allowance(rest, dt)
    out = np.maximum(rows - limits.position_upper, limits.position_lower - rows)
    return Excess(
        max(float(np.max(out)), 0.0),
        _share(speeds, limits.speed_lower, limits.speed_upper, slack[0]),
        _share(accelerations, limits.acceleration_lower, limits.acceleration_upper, slack[1]),
        broken,
    )


def _share(values: Array, lower: Array, upper: Array, slack: float) -> float:
    """Largest share of its bound that a value takes, over `slack`; infinite where one of 0 is passed."""
    values = np.where(np.abs(values) <= slack, 0.0, values)
    bound = np.where(values > 0.0, upper, -lower)
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = np.abs(values) / bound
    return float(np.max(np.where(np.isnan(shares), 0.0, shares)))
