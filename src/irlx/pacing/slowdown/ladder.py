"""Several strengths of smoothing, and the fastest clock among them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.slowdown.clock import PlannedClock, plan_clock
from irlx.pacing.slowdown.clock_bounds import clock_bounds
from irlx.pacing.slowdown.curve import JointCurve
from irlx.pacing.slowdown.grid import PathGrid
from irlx.pacing.slowdown.model import Model
from irlx.pacing.slowdown.relax import Smoothing, relax

Array = NDArray[np.float64]

RUNGS = (None, Smoothing(0.04, 0.0), Smoothing(0.1, 1.0), Smoothing(0.3, 1.0))
"""Strengths tried in turn, the first being the walk as it is."""

GOOD_ENOUGH = 5e-4
"""Loss of time against the programme with which no further rung is tried."""

ROUGH_GAIN = 5e-3
"""Gain of time that an unsmoothed motion must bring where no acceleration limit tames its kinks."""

_PARTS = np.array([0.0, 0.125, 0.25, 0.5, 0.75])
_ROUNDING = 1e-12


@dataclass(frozen=True)
class TimedCurve:
    """A curve q(s), and the fastest clock through it."""

    curve: JointCurve
    clock: PlannedClock


def timed_curves(
    model: Model,
    grid: PathGrid,
    walked: Array,
    bounds: tuple[Array, Array],
    acc: float,
    pinned: Sequence[int] = (),
    reserve: float = 0.0,
) -> list[TimedCurve]:
    """The rungs for the walked postures (N + 1, n), fastest first; none that leaves the position limits.

    `bounds` are lower and upper positions (N + 1, n), `acc` the largest |d2s/dt2|; the postures of the
    knots `pinned` stay; `reserve` (m) is kept beside margins.
    """
    programmed = float(np.sum(grid.times))
    known = np.isfinite(model.limits.acceleration_upper) | np.isfinite(model.limits.acceleration_lower)
    tamed = bool(np.any(known))
    found: list[tuple[float, TimedCurve]] = []
    for rung in RUNGS if tamed else (*RUNGS[1:], RUNGS[0]):
        handicap = 1.0 + ROUGH_GAIN if rung is None and not tamed else 1.0
        timed = _timed(model, grid, walked, bounds, acc, rung, pinned, reserve)
        if timed is not None:
            found.append((timed.clock.duration * handicap, timed))
            if timed.clock.duration <= programmed * (1.0 + GOOD_ENOUGH):
                break
    return [timed for _, timed in sorted(found, key=lambda entry: entry[0])]


def _timed(
    model: Model,
    grid: PathGrid,
    walked: Array,
    bounds: tuple[Array, Array],
    acc: float,
    rung: Smoothing | None,
    pinned: Sequence[int],
    reserve: float,
) -> TimedCurve | None:
    """The curve of one rung with its clock; None where it leaves the position limits, comes too near to
    something or gets lost."""
    try:
        q = walked if rung is None else relax(model, grid, walked, bounds, rung, pinned, reserve)
    except np.linalg.LinAlgError:
        return None
    if not np.all(np.isfinite(q)):
        return None
    limits = model.limits
    curve = JointCurve(grid.s, q)
    between = curve.at((grid.s[:-1, None] + np.diff(grid.s)[:, None] * _PARTS).ravel())
    if (
        float(np.max(np.maximum(between - limits.position_upper, limits.position_lower - between)))
        > _ROUNDING
    ):
        return None
    clearance = model.clearance
    if clearance is not None:
        places = places_between(grid)
        if clearance.first_short(curve.at(places), q[0], grid.times_at(places)) is not None:
            return None
    clock = plan_clock(clock_bounds(curve, limits, grid.rates, acc))
    return TimedCurve(curve, clock) if clock is not None else None


def places_between(grid: PathGrid) -> Array:
    """Path parameters at the inner knots and half way between knots."""
    halves = grid.s[:-1] + 0.5 * np.diff(grid.s)
    return np.sort(np.concatenate([grid.s[1:-1], halves]))
