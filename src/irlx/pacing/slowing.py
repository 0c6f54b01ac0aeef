"""Where and how much a motion was slowed, and what made it slow."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.slowdown.clock import PlannedClock
from irlx.pacing.slowdown.clock_bounds import PATH, Governor

Array = NDArray[np.float64]

SLOWED = 0.999
"""Share of the programmed rate below which a place counts as slowed."""


@dataclass(frozen=True)
class Slowing:
    """A stretch of a motion that runs slower than programmed.

    Rows `first_row` .. `last_row` of the motion (from 0). At `s` (path parameter) most rate is missing:
    `achieved` instead of `requested` (per s), because of the `joint` (from 0; -1 none) and its `governor`,
    SPEED or ACCELERATION. `lost` is the time the stretch costs, s; `span` the path parameters between which
    it does. `lines` of the program are the first and the last one of the moves that it reaches over where
    several are joined.
    """

    first_row: int
    last_row: int
    s: float
    requested: float
    achieved: float
    governor: Governor
    joint: int
    lost: float
    span: tuple[float, float] = (inf, -inf)
    lines: tuple[int, int] | None = None


def slowings(clock: PlannedClock, rates: Array, factor: float, dt: float, rows: int) -> tuple[Slowing, ...]:
    """Slowed stretches of a planned clock against the programmed `rates` (N + 1,) at its knots.

    `factor` is how much slower the rows, one every `dt` s, run than the clock.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(rates > 0.0, np.sqrt(clock.x) / rates, 1.0)
    return tuple(_slowing(clock, rates, share, span, factor, dt, rows) for span in spans(share < SLOWED))


def told_in_ticks(found: tuple[Slowing, ...], later: float) -> tuple[Slowing, ...]:
    """Slowed stretches of a motion that ends `later` (s) than it is programmed to, both in whole ticks.

    What they cost is in all just that; none where the motion takes no longer.
    """
    lost = sum(part.lost for part in found)
    if not (later > 0.0 and lost > 0.0):
        return ()
    return tuple(replace(part, lost=part.lost * later / lost) for part in found)


def _slowing(
    clock: PlannedClock,
    rates: Array,
    share: Array,
    span: tuple[int, int],
    factor: float,
    dt: float,
    rows: int,
) -> Slowing:
    first, last = span
    knots = np.arange(first, last + 1)
    by_joint = knots[clock.joint[first : last + 1] != PATH]
    among = by_joint if by_joint.size else knots
    # Where most speed is missing; by its share the end of a ramp would be named, where little is lost.
    worst = int(among[np.argmax((rates - np.sqrt(clock.x))[among])])
    times = clock.times * factor
    before, behind = max(first - 1, 0), min(last + 1, len(times) - 1)
    programmed = np.sum(
        2.0 * np.diff(clock.s[before : behind + 1]) / (rates[before:behind] + rates[before + 1 : behind + 1])
    )
    ticks = np.clip(np.round(times[[first, last]] / dt).astype(int) - 1, 0, rows - 1)
    return Slowing(
        int(ticks[0]),
        int(ticks[1]),
        float(clock.s[worst]),
        float(rates[worst]),
        float(np.sqrt(clock.x[worst]) / factor),
        Governor(int(clock.governor[worst])),
        int(clock.joint[worst]),
        float(times[behind] - times[before] - programmed),
        (float(clock.s[before]), float(clock.s[behind])),
    )


def spans(mask: NDArray[np.bool_]) -> Iterator[tuple[int, int]]:
    """First and last index of every run of True."""
    edges = np.diff(np.concatenate([[False], mask, [False]]).astype(np.int8))
    for first, beyond in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True):
        yield int(first), int(beyond) - 1
