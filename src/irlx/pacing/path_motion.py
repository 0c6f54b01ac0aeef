"""One motion along a path: the ordinary tick walk where it keeps everything, else a planned motion."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from irlx.diagnostics import IrlxError
from irlx.motion.plan_path import PlannedPath
from irlx.pacing.clock import Clock, programmed_clock
from irlx.pacing.demand import DemandModifier, Demands, demands
from irlx.pacing.posture_term import PostureTerm
from irlx.pacing.resolution import EVERY_TICK, Resolution
from irlx.pacing.row_check import BrokenBound, broken_bound
from irlx.pacing.slowdown.model import Model
from irlx.pacing.slowdown.planned import MotionTask, PlannedMotion, Refusal, Ticking, plan_motion
from irlx.pacing.slowing import Slowing, slowings, told_in_ticks
from irlx.pacing.swinging import swings
from irlx.pacing.touching import touching
from irlx.pacing.walk import Halt, Walk, walk
from irlx.pacing.watch import Watch
from irlx.transform.clearance import Closest
from irlx.transform.precision import RESTRAINTS
from irlx.transform.step_bounds import BoundSource, StepLimiter
from irlx.transform.tick import TickSolver, TickStatus

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PacedPath:
    """Rows q (M, n) of a motion along a path, the hold row not among them.

    `active` (M, n) flags as in `MotionRows`, `demands` of each row, the posture `term` that they follow,
    `slowings` where it runs slower than programmed (empty for an ordinary walk), `planned` whether it is a
    planned motion; `closest` is that of an ordinary walk tick by tick.
    """

    q: Array
    active: NDArray[np.int8]
    demands: Demands
    iterations: int
    term: PostureTerm
    slowings: tuple[Slowing, ...] = ()
    planned: bool = False
    closest: tuple[Closest, ...] | None = None


@dataclass(frozen=True)
class Failure:
    """Why a motion has no rows: what ended the ordinary walk, and why no slower clock helps."""

    halt: Halt | None
    broken: BrokenBound | None
    refusal: Refusal


@dataclass(frozen=True)
class PathMotion:
    """A motion from rest at posture `start` (n,) along a planned path.

    `term` is the posture term in force; ticks of `dt` s, the first of them `first_tick` of the stream;
    `ticks_of` gives the ticks of a duration, or raises what too long a motion deserves; `watch` sees it done.
    """

    plan: PlannedPath
    start: Array
    term: PostureTerm
    dt: float
    first_tick: int
    ticks_of: Callable[[float], int]
    modifiers: Sequence[DemandModifier] = ()
    resolution: Resolution = EVERY_TICK
    watch: Watch | None = None

    def demands_of(self, clock: Clock) -> Demands:
        """Demands of the ticks of a clock, modifiers applied."""
        return demands(self.plan.path, clock, self.first_tick, self.modifiers)


def pace_path(motion: PathMotion, model: Model, solver: TickSolver) -> PacedPath | Failure:
    """Rows of a motion: at the programmed speed where every tick can, else slowed where it must be.

    Where neither is possible with its posture term, with the one that this names instead, and so where it
    makes the joints swing.
    """
    found = _paced_or_otherwise(motion, model, solver)
    calmer = motion.term.calmer
    if calmer is None or isinstance(found, Failure) or not _swings(motion, found, model):
        return found
    second = pace_path(replace(motion, term=calmer), model, solver)
    return found if isinstance(second, Failure) or _swings(motion, second, model) else second


def _swings(motion: PathMotion, found: PacedPath, model: Model) -> bool:
    if motion.resolution.is_coarse:
        return False
    return swings(np.vstack([motion.start, found.q]), model.limits, motion.dt)


def _paced_or_otherwise(motion: PathMotion, model: Model, solver: TickSolver) -> PacedPath | Failure:
    found = _paced(motion, model, solver)
    if isinstance(found, Failure) and motion.term.otherwise is not None:
        second = _paced(replace(motion, term=motion.term.otherwise), model, solver)
        if not isinstance(second, Failure):
            return second
    if isinstance(found, Failure):
        # The path must not pay for a criterion on whose minimum the steps of a tick do not settle.
        return _held_back_or(found, motion, model, solver)
    return found


def _held_back_or(
    failure: Failure, motion: PathMotion, model: Model, solver: TickSolver
) -> PacedPath | Failure:
    """The motion planned with its criterion held back a little, or walked, as far as each tick asks."""
    if _is_unsettled(failure.refusal):
        held = _held_back(motion)
        # Too many ticks for the caller are no reason against a walk, which has fewer.
        with suppress(IrlxError):
            plan = plan_motion(model, _task(held, None))
            if not isinstance(plan, Refusal):
                return _planned(held, model, plan)
            failure = replace(failure, refusal=plan)
    walked, broken = _walked(motion, model, solver.restraining(), thorough=True)
    return _as_walked(motion, walked) if walked.halt is None and broken is None else failure


def _held_back(motion: PathMotion) -> PathMotion:
    return replace(motion, term=motion.term.held_back(RESTRAINTS[0]))


def _is_unsettled(end: Halt | Refusal | None) -> bool:
    """Whether a motion ended at a tick whose steps did not settle; bounds and margins left a way."""
    return end is not None and end.solution is not None and end.solution.status is TickStatus.NOT_CONVERGED


def _paced(motion: PathMotion, model: Model, solver: TickSolver) -> PacedPath | Failure:
    undisturbed = None
    if motion.resolution.is_coarse:
        seen = _glanced(motion, model)
        if isinstance(seen, PacedPath):
            return seen
        undisturbed = seen
    walked, broken = _walked(motion, model, solver, thorough=False)
    kept = walked.halt is None and broken is None
    if kept and not (motion.term.draws and _lags(walked.active)):
        return _as_walked(motion, walked)
    held = _walked_held_back(motion, model, solver) if _is_unsettled(walked.halt) else None
    if held is not None and not _lags(held.active):
        return held
    if motion.watch is not None:
        motion.watch.plans()
    try:
        found = plan_motion(model, _task(motion, undisturbed))
    except IrlxError:
        # Too slow for the caller, or too many ticks: a walk that keeps everything still serves.
        served = _as_walked(motion, walked) if kept else held
        if served is None:
            raise
        return served
    if held is not None and (isinstance(found, Refusal) or len(found.q) > len(held.q)):
        return held
    if not isinstance(found, Refusal):
        return _planned(motion, model, found)
    if not kept:
        # Where no plan is found a walk that looks round every corner may still be.
        walked, broken = _walked(motion, model, solver, thorough=True)
    if walked.halt is None and broken is None:
        return _as_walked(motion, walked)
    return Failure(walked.halt, broken, found)


def _walked_held_back(motion: PathMotion, model: Model, solver: TickSolver) -> PacedPath | None:
    """The walk with its criterion held back a little, if that does every tick: no reason to be slower.

    Not where it draws the joints to a posture, from which that would keep them: a plan reaches it. Where a
    speed or acceleration bound holds a joint the step of a tick may have jumped: a plan that takes no longer
    is smoother.
    """
    if motion.term.draws:
        return None
    held = _held_back(motion)
    walked, broken = _walked(held, model, solver, thorough=False)
    return _as_walked(held, walked) if walked.halt is None and broken is None else None


def _glanced(motion: PathMotion, model: Model) -> PacedPath | Callable[[Array], Array] | None:
    """A few rows of a motion that surely keeps away from all limits; of any other its postures (M, n) at path
    parameters (M,) without them, or None."""
    # Imported here: only a dry run has a use for it.
    from irlx.pacing.glance import Glance, Glanced, glance

    plan = motion.plan
    if motion.modifiers:
        return None
    asked = Glanced(plan.path, plan.law, plan.ticks, motion.start, motion.term, motion.dt, motion.first_tick)
    seen = glance(asked, model)
    if not isinstance(seen, Glance):
        return None if seen is None else seen.at
    return PacedPath(seen.q, np.zeros(seen.q.shape, dtype=np.int8), seen.demands, 0, motion.term)


def _walked(
    motion: PathMotion, model: Model, solver: TickSolver, thorough: bool
) -> tuple[Walk, BrokenBound | None]:
    """The walk at the programmed speed, and the first bound that its rows pass."""
    ticks = motion.plan.ticks
    clock = programmed_clock(motion.plan.law, ticks, motion.dt, motion.resolution.rows_of(ticks))
    asked = motion.demands_of(clock)
    s, advance = asked.s.tolist(), np.diff(clock.s, prepend=0.0).tolist()
    dt = motion.dt * clock.ticks_a_row
    walked = walk(
        solver,
        StepLimiter(model.limits, dt),
        lambda row: motion.term.at(s[row], advance[row]),
        model.free,
        motion.start,
        asked,
        thorough,
        model.clearance,
        None if motion.watch is None else motion.watch.ticked,
    )
    if walked.halt is not None:
        return walked, None
    held = np.vstack([walked.q, walked.q[-1:]])
    broken = broken_bound(motion.start, held, model.limits, dt)
    return walked, broken and broken.counted_in_ticks(clock.ticks_a_row)


def _as_walked(motion: PathMotion, walked: Walk) -> PacedPath:
    closest = None if motion.resolution.is_coarse else walked.closest
    return PacedPath(walked.q, walked.active, walked.demands, walked.iterations, motion.term, closest=closest)


def _task(motion: PathMotion, undisturbed: Callable[[Array], Array] | None) -> MotionTask:
    return MotionTask(
        motion.plan.path,
        motion.plan.programmed,
        motion.plan.programmed.acc,
        motion.start,
        motion.term.at,
        Ticking(motion.dt, motion.ticks_of, motion.demands_of, motion.resolution),
        motion.term.draws,
        motion.term.through,
        undisturbed,
    )


def _planned(motion: PathMotion, model: Model, found: PlannedMotion) -> PacedPath:
    clock = found.timed.clock
    rates = motion.plan.programmed.rates_at(clock.s)
    ticks = int(found.demands.tick[-1]) + 1 - motion.first_tick
    dt = motion.dt * ticks / len(found.q)
    slow = slowings(clock, rates, found.factor, dt, len(found.q))
    return PacedPath(
        found.q,
        touching(motion.start, found.q, model.limits, dt),
        found.demands,
        0,
        motion.term,
        told_in_ticks(slow, motion.dt * (ticks - motion.plan.ticks)),
        True,
    )


def _lags(active: NDArray[np.int8]) -> bool:
    """Whether a speed or acceleration bound kept a joint behind the posture it is drawn to.

    Nothing tells it to slow down before it has caught up: it may swing about the posture, catch up with a
    jump of its speed where no acceleration limit is known, or run on at full speed into the stop of the move.
    """
    source = np.abs(active)
    return bool(np.any((source == 1 + BoundSource.ACCELERATION) | (source == 1 + BoundSource.SPEED)))
