"""The ordinary tick walk: one solved tick after another at the programmed speed."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.demand import Demand, Demands
from irlx.transform.clearance import Clearance, Closest
from irlx.transform.criteria.criterion import Criterion
from irlx.transform.free_run import free_run
from irlx.transform.seeds import Seeds
from irlx.transform.step_bounds import StepBounds, StepLimiter
from irlx.transform.tick import TickSolution, TickSolver
from irlx.transform.tick_problem import TickProblem

Array = NDArray[np.float64]

_AHEAD = 128
_LEAST_AHEAD = 4
_LONGEST_WAIT = 64


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
    demands: Demands
    iterations: int
    halt: Halt | None
    closest: tuple[Closest, ...] | None = None


def walk(
    solver: TickSolver,
    limiter: StepLimiter,
    criterion_of: Callable[[int], Criterion],
    free: NDArray[np.bool_],
    start: Array,
    demands: Iterable[Demand],
    thorough: bool = True,
    clearance: Clearance | None = None,
    ticked: Callable[[int], None] | None = None,
) -> Walk:
    """Walk from rest at posture `start` (n,) through the demands, one tick each.

    `limiter` holds the limits in force, `criterion_of` gives the criterion of a row, `free` (n,) is True
    for the joints that are not frozen, `thorough` is that of `TickSolver.solve`, `clearance` what is kept
    clear of, `ticked` is told the tick of the demand that is worked on. Where nothing stands against them,
    ticks are solved many at a time, see `irlx.transform.free_run`: their rows are the same, but that no
    criterion is held back there.
    """
    walker = _Walker(solver, limiter, criterion_of, free, start, Demands.of(demands), thorough, clearance)
    halt, haste = None, _Haste(solver.runs_free and not (clearance is not None and clearance.moves))
    while walker.row < len(walker.demands) and halt is None:
        if ticked is not None:
            ticked(int(walker.demands.tick[walker.row]))
        ahead = haste.ahead if walker.row else 0
        haste.went(walker.run(ahead) if ahead else 0)
        if walker.row < len(walker.demands):
            halt = walker.tick()
    return walker.walked(halt)


class _Haste:
    """How many ticks a walk runs ahead: more as long as that goes well, none for a while where not."""

    def __init__(self, able: bool) -> None:
        self._able = able
        self._size, self._wait, self._left = _LEAST_AHEAD, 1, 0

    @property
    def ahead(self) -> int:
        """Ticks to be tried next, 0 for none."""
        return self._size if self._able and self._left == 0 else 0

    def went(self, done: int) -> None:
        """Note how many ticks were done, 0 as well where none were tried."""
        if self._left > 0:
            self._left -= 1
        elif done == 0:
            self._size, self._left = _LEAST_AHEAD, self._wait
            self._wait = min(2 * self._wait, _LONGEST_WAIT)
        else:
            whole = done >= self._size
            self._size, self._wait = min(2 * self._size, _AHEAD) if whole else _LEAST_AHEAD, 1


class _Walker:
    """A walk under way, at rest before its first row."""

    def __init__(
        self,
        solver: TickSolver,
        limiter: StepLimiter,
        criterion_of: Callable[[int], Criterion],
        free: NDArray[np.bool_],
        start: Array,
        demands: Demands,
        thorough: bool,
        clearance: Clearance | None,
    ) -> None:
        self._solver, self._limiter, self._criterion_of, self._free = solver, limiter, criterion_of, free
        self._thorough, self._clearance = thorough, clearance
        self.demands = demands
        self.row, self._iterations = 0, 0
        self._at, self._speed, self._seeds = start, np.zeros_like(start), Seeds(start.size)
        self._q = np.empty((len(demands), start.size))
        self._active = np.zeros((len(demands), start.size), dtype=np.int8)
        self._closest: list[Closest] = [None] * len(demands)

    def run(self, ahead: int) -> int:
        """Do as many of the next ticks as nothing stands against; how many that were."""
        part = slice(self.row, self.row + ahead)
        poses, seeds = (self.demands.rotation[part], self.demands.position[part]), self._seeds.copy()
        first, solver = self.row, self._solver
        criteria = map(self._criterion_of, range(first, first + len(poses[0])))
        plain = solver.undisturbed(self._free)
        found = free_run(solver.kinematics, plain, self._at, poses, criteria, seeds)
        count = self._limiter.kept(self._at, self._speed, found.q) if len(found.q) else 0
        if count and self._clearance is not None:
            # A tick needs no look where everything is far at both its ends.
            count = max(self._clearance.far_rows(np.vstack([self._at, found.q[:count]])) - 1, 0)
        if count == 0:
            return 0
        rows = found.q[:count]
        steps = np.diff(rows, axis=0, prepend=self._at[None])
        if count == len(found.q):
            self._seeds = seeds
        else:
            for step in steps[-4:]:
                self._seeds.took(step)
        self._q[first : first + count] = rows
        self._iterations += int(np.sum(found.iterations[:count]))
        self._at, self._speed = self._q[first + count - 1], steps[-1] / self._limiter.dt
        self.row += count
        return count

    def tick(self) -> Halt | None:
        """Do the next tick with all precautions; why it cannot be done, if so."""
        limiter, clearance, row, q = self._limiter, self._clearance, self.row, self._at
        demand = self.demands[row]
        bounds = limiter.bounds(q, self._speed)
        target = self._solver.kinematics.target(demand.rotation, demand.position)
        elapsed = row * limiter.dt
        keeping = clearance.tick(q, limiter.dt, elapsed) if clearance is not None else None
        problem = TickProblem(target, q, bounds, self._criterion_of(row), self._free, keeping)
        seed, span = self._seeds.next(), (elapsed, limiter.dt)
        solution, seen = _solved(self._solver, problem, seed, self._thorough, clearance, span)
        self._iterations += solution.iterations
        if not solution.solved:
            return Halt(demand, bounds, solution)
        # q + (limit - q) may lie one bit beyond the limit.
        reached = limiter.into_positions(solution.q)
        step = reached - q
        self._seeds.took(step)
        self._speed, self._at = step / limiter.dt, reached
        self._q[row] = reached
        if clearance is not None and seen:
            self._closest[row] = clearance.closest(reached, elapsed + limiter.dt)
        if np.count_nonzero(solution.active):
            self._active[row] = active_flags(solution.active, bounds)
        self.row += 1
        return None

    def walked(self, halt: Halt | None) -> Walk:
        """What the walk has come to."""
        done = slice(0, self.row)
        closest = None if self._clearance is None else tuple(self._closest[done])
        rows = self._q[done], self._active[done]
        return Walk(*rows, self.demands[done], self._iterations, halt, closest)


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


def active_flags(active: NDArray[np.int8], bounds: StepBounds) -> NDArray[np.int8]:
    """Sign of the side times (1 + BoundSource) for every joint held by a bound, shape (n,)."""
    source = np.where(active > 0, bounds.upper_source, bounds.lower_source)
    return np.asarray(active * (1 + source), dtype=np.int8)
