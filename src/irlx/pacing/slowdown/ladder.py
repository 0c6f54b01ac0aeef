"""Several strengths of smoothing, and the fastest clock among them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.slowdown.clock import PlannedClock, plan_clock
from irlx.pacing.slowdown.clock_bounds import clock_bounds
from irlx.pacing.slowdown.curve import JointCurve
from irlx.pacing.slowdown.grid import PathGrid
from irlx.pacing.slowdown.model import Model
from irlx.pacing.slowdown.relax import Smoothing, relax
from irlx.pacing.slowdown.smooth_clock import SmoothRate

Array = NDArray[np.float64]

RUNGS = (None, Smoothing(0.04, 0.0), Smoothing(0.1, 1.0), Smoothing(0.3, 1.0))
"""Strengths tried in turn, the first being the walk as it is."""

GOOD_ENOUGH = 5e-4
"""Loss of time against the programme with which no further rung is tried."""

UNTOLD = 8e-3
"""The same in a dry run, where so little is not told (IRL445)."""

ROUGH_GAIN = 5e-3
"""Gain of time that an unsmoothed motion must bring where no acceleration limit tames its kinks."""

_LONG = 4.0
"""Times the programmed duration from which on no rung is passed over: the motion may not stand in another."""

_PARTS = np.array([0.0, 0.125, 0.25, 0.5, 0.75])
_ROUNDING = 1e-12


@dataclass(frozen=True)
class TimedCurve:
    """A curve q(s), and the fastest clock through it; `smooth` is that with the programme's bound on jerk,
    `jerk_at` what this is at path parameters (M,).
    """

    curve: JointCurve
    clock: PlannedClock
    smooth: PlannedClock | None = None
    jerk_at: Callable[[Array], Array] | None = None

    @property
    def duration(self) -> float:
        """Time (s) of the motion."""
        return (self.clock if self.smooth is None else self.smooth).duration


def timed_curves(
    model: Model,
    grid: PathGrid,
    walked: Array,
    bounds: tuple[Array, Array],
    acc: float | Array,
    pinned: Sequence[int] = (),
    reserve: float = 0.0,
    least_gain: float = 0.0,
    kinked: bool = True,
    smooth: SmoothRate | None = None,
) -> Iterator[TimedCurve]:
    """The rungs for the walked postures (N + 1, n), fastest first; none that leaves the position limits or
    comes too near to something. That is looked at when a rung is asked for.

    `bounds` are lower and upper positions (N + 1, n), `acc` the largest |d2s/dt2|, (N,) or one; the postures
    of the knots `pinned` stay; `reserve` (m) is kept beside margins. Rungs behind one that does not gain the
    part `least_gain` of the time come last, whatever their clock; so do all behind a walk that is not
    `kinked`. `smooth` is given where the programme bounds the jerk.
    """
    programmed = float(np.sum(grid.times))
    known = np.isfinite(model.limits.acceleration_upper) | np.isfinite(model.limits.acceleration_lower)
    tamed = bool(np.any(known))
    found: list[tuple[float, TimedCurve]] = []
    for rung in _in_turn(tamed or not kinked, least_gain > 0.0):
        handicap = 1.0 + ROUGH_GAIN if rung is None and not tamed and kinked else 1.0
        timed = _timed(model, grid, walked, bounds, acc, rung, pinned, reserve, smooth)
        if timed is None:
            continue
        duration = timed.duration
        enough = duration <= programmed * (1.0 + (GOOD_ENOUGH if least_gain == 0.0 else UNTOLD))
        if enough and not _clear(model, grid, timed.curve):
            continue
        best = min((before for before, _ in found), default=np.inf)
        found.append((duration * handicap, timed))
        if enough:
            break
        gains = kinked and (best == np.inf or duration * handicap < best * (1.0 - least_gain))
        if least_gain > 0.0 and not gains and min(best, duration) < _LONG * programmed:
            yield from _clear_ones(model, grid, found)
            found = []
    yield from _clear_ones(model, grid, found)


def _in_turn(tamed: bool, quick: bool) -> tuple[Smoothing | None, ...]:
    """The rungs in the order in which they are tried, `quick`: what tells most about the others first."""
    light, middle, strong = RUNGS[1:]
    smooth = (strong, middle, light) if quick else (light, middle, strong)
    return (None, *smooth) if tamed else (*smooth, None)


def _clear_ones(model: Model, grid: PathGrid, found: list[tuple[float, TimedCurve]]) -> Iterator[TimedCurve]:
    """Those that come too near to nothing, fastest first."""
    for _, timed in sorted(found, key=lambda entry: entry[0]):
        if _clear(model, grid, timed.curve):
            yield timed


def _clear(model: Model, grid: PathGrid, curve: JointCurve) -> bool:
    """Whether a curve comes too near to nothing."""
    if model.clearance is None:
        return True
    places = places_between(grid)
    return model.clearance.first_short(curve.at(places), curve.q[0], grid.times_at(places)) is None


def _timed(
    model: Model,
    grid: PathGrid,
    walked: Array,
    bounds: tuple[Array, Array],
    acc: float | Array,
    rung: Smoothing | None,
    pinned: Sequence[int],
    reserve: float,
    smooth: SmoothRate | None,
) -> TimedCurve | None:
    """The curve of one rung with its clock; None where it leaves the position limits or gets lost."""
    try:
        q = walked if rung is None else relax(model, grid, walked, bounds, rung, pinned, reserve)
    except np.linalg.LinAlgError:
        return None
    if not np.all(np.isfinite(q)):
        return None
    limits = model.limits
    curve = JointCurve(grid.s, q)
    between = curve.at(inner_places(grid))
    if (
        float(np.max(np.maximum(between - limits.position_upper, limits.position_lower - between)))
        > _ROUNDING
    ):
        return None
    clock = plan_clock(clock_bounds(curve, limits, grid.rates, acc))
    if clock is None:
        return None
    if smooth is None:
        return TimedCurve(curve, clock)
    return TimedCurve(curve, clock, smooth.clock(curve, limits), smooth.law.jerk_at)


def inner_places(grid: PathGrid) -> Array:
    """Path parameters of the knots but the last, and of places between, at which limits are looked at."""
    return np.asarray((grid.s[:-1, None] + np.diff(grid.s)[:, None] * _PARTS).ravel())


def places_between(grid: PathGrid) -> Array:
    """Path parameters at the inner knots and half way between knots."""
    halves = grid.s[:-1] + 0.5 * np.diff(grid.s)
    return np.sort(np.concatenate([grid.s[1:-1], halves]))
