"""A whole motion planned: from its path to rows that keep every bound, or the reason why there are none."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import LimitKind
from irlx.motion.pose_path import PosePath, Poses
from irlx.motion.time_law import TimeLaw
from irlx.pacing.clock import Clock
from irlx.pacing.demand import Demands
from irlx.pacing.resolution import EVERY_TICK, Resolution, ticks_before
from irlx.pacing.row_check import BrokenBound, excess_of
from irlx.pacing.slowdown.clock import PlannedClock
from irlx.pacing.slowdown.curve import JointCurve
from irlx.pacing.slowdown.drawn_end import with_drawn_end
from irlx.pacing.slowdown.elastic_walk import elastic_walk
from irlx.pacing.slowdown.grid import FINE, PathGrid, acc_between, path_grid
from irlx.pacing.slowdown.ladder import TimedCurve, inner_places, places_between, timed_curves
from irlx.pacing.slowdown.model import Model
from irlx.pacing.slowdown.resample import resample
from irlx.pacing.slowdown.reserve import RESERVE, reserved
from irlx.pacing.slowdown.short_ends import with_short_ends
from irlx.pacing.slowdown.smooth_clock import SmoothRate
from irlx.transform.clearance import TooNear
from irlx.transform.criteria.criterion import Criterion
from irlx.transform.nearest import scaled_singular_values
from irlx.transform.tick import TickSolution

Array = NDArray[np.float64]

SLOWEST_SHARE = 1e-3
"""Share of the programmed rate below which a motion counts as standing."""

LONGEST_STAND = 2.0
"""Time (s) that a motion may stand in all at a singular place."""

SINGULAR_SHARE = 1e-3
"""Smallest over largest singular value of the scaled Jacobian below which a place counts as singular."""

COARSE_GAIN = 3e-3
"""Part of its time that a dry run must win by smoothing for more of it to be tried."""

_ON_PATH = 1e-8
_STRETCHES = 8
_RESERVES = 4
_RESERVE_GROWTH = 4.0
_STRETCH_MARGIN = 1e-6
_LARGEST_STRETCH = 2.0
_SAME_JERK, _MOST_FOR_JERK = 1e-9, 1.03


@dataclass(frozen=True)
class PlannedMotion:
    """Rows q (M, n) of ticks 1 .. M, their demands, and the clock they follow, `factor` times slower."""

    q: Array
    demands: Demands
    timed: TimedCurve
    factor: float


@dataclass(frozen=True)
class Refusal:
    """Why no clock, however slow, leads through a motion, and where on the path (`s`).

    `solution` holds the failed step of the walk. Else the clock of `timed` stands at `knot`, for the bound
    it names. Else only the differences of the rows say no: `broken`, its row counted in ticks from the start
    of the motion. Or something comes too `near`, at a `tick` counted from there. `reserve` (m) is what
    the walk kept beside margins, and `elapsed` the time (s) from the start at which its step failed.
    """

    s: float
    solution: TickSolution | None = None
    timed: TimedCurve | None = None
    knot: int = -1
    broken: BrokenBound | None = None
    near: TooNear | None = None
    tick: int = 0
    reserve: float = 0.0
    elapsed: float = 0.0


@dataclass(frozen=True)
class Ticking:
    """How a clock becomes ticks of `dt` s: `ticks_of` a duration, and `demands_of` a clock's ticks.

    `ticks_of` may raise what a motion of too many ticks deserves; `resolution` tells how many rows stand for
    the ticks.
    """

    dt: float
    ticks_of: Callable[[float], int]
    demands_of: Callable[[Clock], Demands]
    resolution: Resolution = EVERY_TICK


@dataclass(frozen=True)
class MotionTask:
    """A motion to plan from posture `start` (n,): its path, programmed law, criterion by path parameter.

    `acc` is the largest |d2s/dt2|; `draws` tells that the criterion draws the joints to a posture, and
    `through` at which path parameters on the way others are asked for. `undisturbed` gives postures (M, n) at
    path parameters (M,) without bounds, roughly, where a dry run knows them.
    """

    path: PosePath
    law: TimeLaw
    acc: float
    start: Array
    criterion_of: Callable[[float, float], Criterion]
    ticking: Ticking
    draws: bool = False
    through: tuple[float, ...] = ()
    undisturbed: Callable[[Array], Array] | None = None


def plan_motion(model: Model, task: MotionTask) -> PlannedMotion | Refusal:
    """Plan a motion from rest to rest that slows down just where a joint bound asks for it.

    See docs/reference/pacing.md for the method and what it promises.
    """
    found = _planned_or_otherwise(replace(model, free=model.movable), task)
    resolution = task.ticking.resolution
    if isinstance(found, PlannedMotion) or found.broken is None or resolution.spacing == FINE:
        return found
    # Between the few knots of a dry run curves swing farther out than in a run.
    fine = replace(task.ticking, resolution=replace(resolution, spacing=FINE))
    return _planned_or_otherwise(replace(model, free=model.movable), replace(task, ticking=fine))


def _planned_or_otherwise(model: Model, task: MotionTask) -> PlannedMotion | Refusal:
    """The motion, with joints at rest that would only swing where it needs that."""
    narrow = model.narrow
    # A band of WITH TOLERANCE has no limits of its own; in a narrow one nothing is won.
    idle = narrow & model.limitless
    first = None if task.draws else _planned_without(model, idle, task)
    if first is not None:
        return first
    found = _planned(model, task)
    if not isinstance(found, Refusal):
        return found
    # A joint that must not go back needs a curve without the least swing, one in a narrow range nearly so;
    # at rest it has one.
    one_way = (model.limits.speed_lower == 0.0) | (model.limits.speed_upper == 0.0)
    return _planned_without(model, one_way, task) or _planned_without(model, narrow, task) or found


def _planned_without(model: Model, resting: NDArray[np.bool_], task: MotionTask) -> PlannedMotion | None:
    """The motion with some joints (n,) at rest, None where there is none, or too few others move."""
    if not np.any(model.free & resting):
        return None
    held = replace(model, free=model.free & ~resting)
    found = _planned(held, task)
    return found if isinstance(found, PlannedMotion) and _keeps_path(model, found) else None


def _keeps_path(model: Model, found: PlannedMotion) -> bool:
    """Whether rows have all of their poses, also where joints at rest leave too few for that."""
    poses = Poses(found.demands.position, found.demands.rotation)
    twists, _ = model.differences(found.q, model.targets(poses))
    return bool(np.max(np.abs(twists)) <= _ON_PATH)


def _planned(model: Model, task: MotionTask) -> PlannedMotion | Refusal:
    """The motion with the joints that are free, its reserve widened where rows pass a limit or margin.

    What came too near with the least reserve is the reason why there is none.
    """
    grid = path_grid(task.path, task.law, task.ticking.resolution.spacing)
    reserve = RESERVE
    found: PlannedMotion | Refusal = Refusal(0.0)
    first: Refusal | None = None
    for _ in range(_RESERVES):
        bounds = reserved(model.limits, grid.intervals + 1, reserve)
        found = _with_reserve(model, task, grid, bounds, reserve)
        if not isinstance(found, Refusal):
            return found
        if found.broken is None and found.near is None:
            break
        first = found if first is None and found.near is not None else first
        reserve *= _RESERVE_GROWTH
    return found if first is None else first


def _with_reserve(
    model: Model, task: MotionTask, grid: PathGrid, bounds: tuple[Array, Array], reserve: float
) -> PlannedMotion | Refusal:
    coarse = task.ticking.resolution.is_coarse
    easy = _undisturbed(model, task, grid, bounds, reserve) if coarse else None
    if easy is None:
        passage = elastic_walk(model, grid, task.start, task.criterion_of, bounds, reserve, coarse)
        if passage.stopped is not None:
            interval, solution = passage.stopped
            place = float(grid.s[interval + 1])
            return Refusal(place, solution=solution, reserve=reserve, elapsed=passage.elapsed)
    elif model.clearance is not None and model.clearance.stays_clear(easy):
        model = replace(model, clearance=None)
    q = passage.q if easy is None else easy
    # Knots are close: the one next to a place stands for it.
    through = tuple(grid.inner_knot(place) for place in task.through)
    if task.draws:
        q = with_drawn_end(model, grid, q, bounds, task.criterion_of, through)
    least_gain = COARSE_GAIN if coarse else 0.0
    kinked = easy is None
    smooth = _smooth(task, grid)
    curves = timed_curves(
        model, grid, q, bounds, _acc(task, grid), through, reserve, least_gain, kinked, smooth=smooth
    )
    fastest = next(curves, None)
    if fastest is None:
        return _outside(model, grid, q, task.ticking.dt)
    standing = _standing(model, fastest, grid)
    if standing is not None:
        return Refusal(float(grid.s[standing]), timed=fastest, knot=standing)
    found: PlannedMotion | Refusal = Refusal(0.0)
    # A rougher curve may have places where its clock stands, although the best one has none.
    for timed in chain([fastest], curves):
        if not np.isfinite(timed.clock.duration):
            continue
        # The path correction of a rough curve may pass a position limit on which a joint starts.
        try:
            found = rows_on_clock(
                model, _with_short_ends(model, timed, task, grid), task.ticking, float(np.sum(grid.times))
            )
        except np.linalg.LinAlgError:
            knot = _most_singular(model, timed, grid)
            found = Refusal(float(grid.s[knot]), timed=timed, knot=knot)
        if isinstance(found, PlannedMotion):
            break
    return found


def _with_short_ends(model: Model, timed: TimedCurve, task: MotionTask, grid: PathGrid) -> TimedCurve:
    if timed.smooth is not None:
        return replace(timed, clock=timed.smooth)
    rates, acc = (grid.rates, task.law.rates_at), _acc(task, grid)
    return replace(timed, clock=with_short_ends(timed.clock, timed.curve, model.limits, *rates, acc))


def _smooth(task: MotionTask, grid: PathGrid) -> SmoothRate | None:
    """How to plan clocks that keep the programme's bound on jerk, where it has one."""
    coarse = task.ticking.resolution.is_coarse
    # Half a tick: differences of rows tell what happens between ticks, evenly spread.
    smooth = SmoothRate(task.law, task.acc, grid.step if coarse else min(0.5 * task.ticking.dt, grid.step))
    return smooth if smooth.bounds_jerk else None


def _acc(task: MotionTask, grid: PathGrid) -> Array:
    """Largest |d2s/dt2| between the knots (N,): that of the whole motion, less where a move allows less."""
    return np.minimum(task.acc, acc_between(task.law, grid.s))


def _undisturbed(
    model: Model, task: MotionTask, grid: PathGrid, bounds: tuple[Array, Array], reserve: float
) -> Array | None:
    """Postures (N + 1, n) of the knots where a dry run finds them all at once; else None."""
    # Imported here: only a dry run has a use for it.
    from irlx.pacing.slowdown.undisturbed import undisturbed_postures

    if task.undisturbed is None:
        return None
    guess = task.undisturbed(grid.s)
    guess[0], guess[:, ~model.free] = task.start, task.start[~model.free]
    return undisturbed_postures(model, grid, guess, task.criterion_of, bounds, reserve)


def _most_singular(model: Model, timed: TimedCurve, grid: PathGrid) -> int:
    """Knot whose Jacobian is nearest to losing its rank."""
    _, jacobians = model.differences(timed.curve.q, model.targets(grid.poses))
    return int(np.argmin(np.linalg.svd(jacobians, compute_uv=False)[:, -1]))


def _outside(model: Model, grid: PathGrid, q: Array, dt: float) -> Refusal:
    """Where the curve through walked postures (N + 1, n) leaves a position limit most, or comes too near."""
    lower, upper = model.limits.pair("position")
    if model.clearance is not None and np.all((q <= upper) & (q >= lower)):
        places = places_between(grid)
        short = model.clearance.first_short(JointCurve(grid.s, q).at(places), q[0], grid.times_at(places))
        if short is not None:
            return Refusal(float(places[short[0]]), near=short[1])
    # Where no knot is outside the curve swings out between two of them.
    places = np.append(inner_places(grid), grid.s[-1])
    between = JointCurve(grid.s, q).at(places)
    over, under = between - upper, lower - between
    row, joint = np.unravel_index(int(np.argmax(np.maximum(over, under))), between.shape)
    bound = float((upper if over[row, joint] >= under[row, joint] else lower)[joint])
    tick = int(grid.times_at(places[row : row + 1])[0] / dt)
    value = float(between[row, joint])
    return Refusal(float(places[row]), broken=BrokenBound(tick, int(joint), LimitKind.POSITION, value, bound))


def _standing(model: Model, timed: TimedCurve, grid: PathGrid) -> int | None:
    """Knot at which the clock stands for good, or nearly so at a singular posture; else None.

    A limit that merely makes a motion slow is no reason to refuse it.
    """
    clock = timed.clock
    inner = clock.x[1:-1]
    if np.any(inner <= 0.0):
        return int(np.argmin(inner)) + 1
    shares = np.sqrt(np.maximum(clock.x[:-1], clock.x[1:])) / np.maximum(grid.rates[:-1], grid.rates[1:])
    slow = shares < SLOWEST_SHARE
    if float(np.sum(np.diff(clock.times)[slow])) <= LONGEST_STAND:
        return None
    knot = int(np.argmin(np.where(slow, shares, np.inf))) + 1
    q, kinematics = timed.curve.q[knot], model.kinematics
    _, jacobian = kinematics.here(q)
    values = scaled_singular_values(jacobian[:, model.free], kinematics.row_scale)
    return knot if values[-1] < SINGULAR_SHARE * values[0] else None


def rows_on_clock(model: Model, timed: TimedCurve, ticking: Ticking, least: float) -> PlannedMotion | Refusal:
    """Rows at the whole ticks of a clock, of `least` s or longer, slowed where differences pass a bound."""
    start = timed.curve.q[0]
    duration = max(timed.clock.duration, least)
    found: PlannedMotion | Refusal = Refusal(0.0)
    for _ in range(_STRETCHES):
        ticks = ticking.ticks_of(duration)
        rows = ticking.resolution.rows_of(ticks)
        whole = ticks * ticking.dt
        factor = whole / timed.clock.duration
        demands = ticking.demands_of(_clock(timed.clock, ticks, rows, ticking.dt, factor))
        q = resample(model, timed.curve, demands.s, Poses(demands.position, demands.rotation))
        excess = excess_of(start, np.vstack([q, q[-1:]]), model.limits, whole / rows)
        broken = excess.first
        rougher = 1.0 if ticking.resolution.is_coarse else _rougher(timed, demands.s, ticking.dt)
        if broken is None and rougher > 1.0:
            duration = whole * rougher * (1.0 + _STRETCH_MARGIN)
            continue
        if broken is None:
            if model.clearance is not None:
                elapsed = whole / rows * np.arange(1.0, rows + 1.0)
                short = model.clearance.first_short(q, start, elapsed)
                if short is not None:
                    tick = ticks_before(short[0], ticks / rows)
                    return Refusal(demands[short[0]].s, near=short[1], tick=tick)
            return PlannedMotion(q, demands, timed, factor)
        place = demands[min(broken.row, rows - 1)].s
        found = Refusal(place, broken=broken.counted_in_ticks(ticks / rows))
        slower = max(excess.speed, np.sqrt(excess.acceleration)) * (1.0 + _STRETCH_MARGIN)
        duration = max(whole * slower, duration)
        if excess.position > 0.0 or slower > _LARGEST_STRETCH:
            break
    return found


def _rougher(timed: TimedCurve, s: Array, dt: float) -> float:
    """Times slower that a clock would have to run for rows at s (M,) to keep the jerk of the programme.

    1 where it is not to be kept, and where knots are so far apart that differences of rows see each of them.
    """
    if timed.smooth is None or timed.jerk_at is None:
        return 1.0
    # Two rows of rest on either side, and the start: differences as a verifier would take them.
    held = np.concatenate([np.zeros(3), s, np.full(2, s[-1])])
    jerk = np.abs(np.diff(held, 3)) / dt**3
    allowed = np.maximum(timed.jerk_at(held[:-3]), timed.jerk_at(held[3:]))
    slower = float(np.cbrt(np.max(jerk / allowed)))
    return slower if 1.0 + _SAME_JERK < slower < _MOST_FOR_JERK else 1.0


def _clock(planned: PlannedClock, ticks: int, rows: int, dt: float, factor: float) -> Clock:
    """Rows of whole ticks of a planned clock that runs `factor` times slower; the last one is the end."""
    s, rate = planned.at(ticks / rows * dt * np.arange(1.0, rows + 1.0) / factor)
    s[-1], rate[-1] = planned.s[-1], 0.0
    return Clock(s, rate / factor, ticks / rows)
