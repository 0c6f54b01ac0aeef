"""The ordinary tick walk: one solved tick after another at the programmed speed."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.demand import Demand
from irlx.transform.criteria.criterion import Criterion
from irlx.transform.step_bounds import StepBounds, StepLimiter
from irlx.transform.tick import TickProblem, TickSolution, TickSolver

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Halt:
    """The tick a walk could not do: its demand, bounds of the step, and the failed solution."""

    demand: Demand
    bounds: StepBounds
    solution: TickSolution


@dataclass(frozen=True)
class Walk:
    """Postures of the ticks done: `q` (k, n), `active` (k, n) as in `MotionRows`, `demands` of each tick.

    `halt` is None where every tick was done.
    """

    q: Array
    active: NDArray[np.int8]
    demands: tuple[Demand, ...]
    iterations: int
    halt: Halt | None


def walk(
    solver: TickSolver,
    limiter: StepLimiter,
    criterion_of: Callable[[Demand], Criterion],
    free: NDArray[np.bool_],
    start: Array,
    demands: Iterable[Demand],
) -> Walk:
    """Walk from rest at posture `start` (n,) through the demands, one tick each.

    `limiter` holds the limits in force, `criterion_of` gives the criterion of a tick, `free` (n,) is True
    for the joints that are not frozen.
    """
    q, speed = start, np.zeros_like(start)
    rows: list[Array] = []
    flags: list[NDArray[np.int8]] = []
    done: list[Demand] = []
    iterations = 0
    halt: Halt | None = None
    for demand in demands:
        bounds = limiter.bounds(q, speed)
        target = solver.kinematics.target(demand.rotation, demand.position)
        solution = solver.solve(TickProblem(target, q, bounds, criterion_of(demand), free))
        iterations += solution.iterations
        if not solution.solved:
            halt = Halt(demand, bounds, solution)
            break
        # q + (limit - q) may lie one bit beyond the limit.
        reached = limiter.limits.into_positions(solution.q)
        speed = (reached - q) / limiter.dt
        q = reached
        rows.append(q)
        flags.append(active_flags(solution.active, bounds))
        done.append(demand)
    joints = start.size
    return Walk(
        np.array(rows).reshape(-1, joints),
        np.array(flags, dtype=np.int8).reshape(-1, joints),
        tuple(done),
        iterations,
        halt,
    )


def active_flags(active: NDArray[np.int8], bounds: StepBounds) -> NDArray[np.int8]:
    """Sign of the side times (1 + BoundSource) for every joint held by a bound, shape (n,)."""
    source = np.where(active > 0, bounds.upper_source, bounds.lower_source)
    return np.asarray(active * (1 + source), dtype=np.int8)
