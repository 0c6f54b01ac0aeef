"""The ordinary tick walk: one solved tick after another at the programmed speed."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.demand import Demand
from irlx.transform.clearance import Clearance, Closest
from irlx.transform.criteria.criterion import Criterion
from irlx.transform.step_bounds import StepBounds, StepLimiter
from irlx.transform.tick import TickSolution, TickSolver
from irlx.transform.tick_problem import TickProblem

Array = NDArray[np.float64]

_CONTINUATION = (-1.0, 4.0, -6.0, 4.0)
"""Weights of the last four steps, the oldest first."""

_CONTINUATION_AT = [np.roll(_CONTINUATION, k) for k in range(len(_CONTINUATION))]
"""The same for a ring of steps in which the oldest one stands at place k."""


@dataclass(frozen=True)
class Halt:
    """The tick a walk could not do: its demand, bounds of the step, and the failed solution."""

    demand: Demand
    bounds: StepBounds
    solution: TickSolution


@dataclass(frozen=True)
class Walk:
    """Postures of the ticks done: `q` (k, n), `active` (k, n) as in `MotionRows`, `demands` of each tick.

    `halt` is None where every tick was done. `closest` is what came nearest in each row, None where nothing
    is kept clear.
    """

    q: Array
    active: NDArray[np.int8]
    demands: tuple[Demand, ...]
    iterations: int
    halt: Halt | None
    closest: tuple[Closest, ...] | None = None


def walk(
    solver: TickSolver,
    limiter: StepLimiter,
    criterion_of: Callable[[Demand], Criterion],
    free: NDArray[np.bool_],
    start: Array,
    demands: Iterable[Demand],
    thorough: bool = True,
    clearance: Clearance | None = None,
) -> Walk:
    """Walk from rest at posture `start` (n,) through the demands, one tick each.

    `limiter` holds the limits in force, `criterion_of` gives the criterion of a tick, `free` (n,) is True
    for the joints that are not frozen, `thorough` is that of `TickSolver.solve`, `clearance` what is kept
    clear of.
    """
    q, speed = start, np.zeros_like(start)
    joints = start.size
    seeds = _Seeds(joints)
    unheld = np.zeros(joints, dtype=np.int8)
    rows: list[Array] = []
    flags: list[NDArray[np.int8]] = []
    done: list[Demand] = []
    closest: list[Closest] = []
    iterations = 0
    halt: Halt | None = None
    for demand in demands:
        bounds = limiter.bounds(q, speed)
        target = solver.kinematics.target(demand.rotation, demand.position)
        elapsed = len(rows) * limiter.dt
        keeping = clearance.tick(q, limiter.dt, elapsed) if clearance is not None else None
        problem = TickProblem(target, q, bounds, criterion_of(demand), free, keeping)
        solution, seen = _solved(solver, problem, seeds.next(), thorough, clearance, (elapsed, limiter.dt))
        iterations += solution.iterations
        if not solution.solved:
            halt = Halt(demand, bounds, solution)
            break
        # q + (limit - q) may lie one bit beyond the limit.
        reached = limiter.into_positions(solution.q)
        step = reached - q
        seeds.took(step)
        speed = step / limiter.dt
        q = reached
        rows.append(q)
        if clearance is not None:
            closest.append(clearance.closest(q, elapsed + limiter.dt) if seen else None)
        held = np.count_nonzero(solution.active) > 0
        flags.append(active_flags(solution.active, bounds) if held else unheld)
        done.append(demand)
    return Walk(
        np.array(rows).reshape(-1, joints),
        np.array(flags, dtype=np.int8).reshape(-1, joints),
        tuple(done),
        iterations,
        halt,
        None if clearance is None else tuple(closest),
    )


def _solved(
    solver: TickSolver,
    problem: TickProblem,
    seed: Array,
    thorough: bool,
    clearance: Clearance | None,
    span: tuple[float, float],
) -> tuple[TickSolution, bool]:
    """The solution of a tick, found again with floors where all was far and it ends near something.

    `span`: begin and duration (s) of the tick. Also tells whether anything may be near at its end.
    """
    solution = solver.solve(problem, seed, thorough)
    if clearance is None or problem.clearance is not None or not solution.solved:
        return solution, clearance is not None
    if not clearance.nears(solution.q, span[0] + span[1]):
        return solution, False
    watched = clearance.watched_tick(problem.q, span[1], span[0])
    if not len(watched.near.pairs) and watched.kept(solution.q - problem.q):
        return solution, True
    watched = clearance.watched_tick(problem.q, span[1], span[0])
    return solver.solve(problem._replace(clearance=watched), seed, thorough), True


class _Seeds:
    """Continues the last steps of a walk as a cubic in time: where Newton's method begins a tick.

    S_k = 4 S_(k-1) - 6 S_(k-2) + 4 S_(k-3) - S_(k-4); a walk begins at rest.
    """

    def __init__(self, joints: int) -> None:
        self._last = np.zeros((len(_CONTINUATION), joints))
        self._count = 0

    def next(self) -> Array:
        """Step (n,) that continues the last ones."""
        return np.asarray(_CONTINUATION_AT[self._count % len(_CONTINUATION)].dot(self._last))

    def took(self, step: Array) -> None:
        """Note the step (n,) of a tick."""
        self._last[self._count % len(_CONTINUATION)] = step
        self._count += 1


def active_flags(active: NDArray[np.int8], bounds: StepBounds) -> NDArray[np.int8]:
    """Sign of the side times (1 + BoundSource) for every joint held by a bound, shape (n,)."""
    source = np.where(active > 0, bounds.upper_source, bounds.lower_source)
    return np.asarray(active * (1 + source), dtype=np.int8)
