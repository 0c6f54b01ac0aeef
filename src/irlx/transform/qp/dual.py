"""The QP by a dual active-set method: exact for small problems, and sure of what has no solution.

Goldfarb and Idnani, A numerically stable dual method for solving strictly convex quadratic programs,
Mathematical Programming 27, 1983; here with the unit matrix as Hessian.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.transform.precision import EMPTY_INTERVAL
from irlx.transform.qp.solver import Array, QpSolution

_ROUNDING = 1e-12
_NO_SLOPE = 1e-13
_DEPENDENT = 1e-11
_LEFT_OUTSIDE = 1e-10
_INDEPENDENT = 1e-10
_ROUNDS_PER_ROW = 10


class DualSolver:
    """Solves the least-norm problem from z = 0: takes in broken rows one by one, the worst first."""

    def solve(
        self, rows: Array, lower: Array, upper: Array, guess: NDArray[np.int8] | None = None
    ) -> QpSolution:
        """Solve min 1/2 |z|^2 with lower <= A z <= upper, A of shape (n, r).

        `guess` (n,), the active rows of a problem that is much alike, saves steps and decides nothing.
        """
        lengths = np.sqrt(np.einsum("ij,ij->i", rows, rows))
        # A row of rounding alone, of a joint that only the path moves, must not be taken for a slope.
        flat = lengths <= _NO_SLOPE * float(lengths.max(initial=0.0))
        impossible = flat & ((lower > EMPTY_INTERVAL) | (upper < -EMPTY_INTERVAL))
        if (lower > upper).any() or impossible.any():
            return QpSolution(None, np.zeros(rows.shape[0], dtype=np.int8))
        low, high = np.where(flat, -np.inf, lower), np.where(flat, np.inf, upper)
        iteration = _Iteration(rows, low, high, lengths)
        if guess is not None:
            iteration.begin(guess)
        return iteration.run()


class _Iteration:
    """State of one solve: z, the rows held with their sides, and their multipliers (>= 0)."""

    def __init__(self, rows: Array, lower: Array, upper: Array, lengths: Array) -> None:
        self._rows, self._lower, self._upper = rows, lower, upper
        self._lengths = lengths
        self._z = np.zeros(rows.shape[1])
        self._held: list[int] = []
        self._sides: list[float] = []
        self._multipliers: Array = np.zeros(0)
        self._passed_over: list[int] = []

    def begin(self, guess: NDArray[np.int8]) -> None:
        """Hold the rows of a guess, but those that would have to be pulled at instead of pushed."""
        bounds = np.where(guess > 0, self._upper, self._lower)
        held = np.flatnonzero((guess != 0) & np.isfinite(bounds))
        while held.size:
            sides, values = guess[held].astype(float), bounds[held]
            normals = -sides[:, None] * self._rows[held]
            gram = normals @ normals.T
            try:
                multipliers = np.linalg.solve(gram, -sides * values)
            except np.linalg.LinAlgError:
                return
            pushed = multipliers > 0.0
            if not np.isfinite(multipliers).all() or _lost(gram, held.size):
                return
            if pushed.all():
                self._held, self._sides = held.tolist(), sides.tolist()
                self._multipliers, self._z = multipliers, normals.T @ multipliers
                return
            held = held[pushed]

    def run(self) -> QpSolution:
        for _ in range(_ROUNDS_PER_ROW * len(self._rows)):
            broken = self._worst()
            if broken is None:
                return self._solution()
            if not self._take_in(*broken):
                return QpSolution(None, self._active())
        return QpSolution(None, self._active())

    def _worst(self) -> tuple[int, float, float] | None:
        """Row that is broken most, the side (+1 upper, -1 lower) and by how much; None where all hold."""
        reached = self._rows @ self._z
        over, under = reached - self._upper, self._lower - reached
        excess = np.maximum(over, under)
        excess[self._held + self._passed_over] = -np.inf
        row = int(excess.argmax())
        # What rounding of the products can leave is no offence.
        slack = _ROUNDING * max(float(np.abs(reached).max()), float(self._lengths[row]) * 1e-3)
        if excess[row] <= slack:
            return None
        return row, (1.0 if over[row] > under[row] else -1.0), float(excess[row])

    def _take_in(self, row: int, side: float, excess: float) -> bool:
        """Move z onto the bound of a row, letting go of held rows on the way; False where no z exists."""
        normal = -side * self._rows[row]
        gained = 0.0
        while True:
            pull, direction = self._split(normal)
            rate = float(direction @ normal)
            open_way = rate > _DEPENDENT * max(float(normal @ normal), 1e-300)
            to_bound = excess / rate if open_way else np.inf
            release, to_release = self._first_released(pull)
            step = min(to_bound, to_release)
            if not np.isfinite(step):
                self._passed_over.append(row)
                return excess <= self._rounding_of(pull)
            if open_way:
                self._z = self._z + step * direction
                excess -= step * rate
            self._multipliers = self._multipliers - step * pull
            gained += step
            if step == to_bound:
                self._held.append(row)
                self._sides.append(side)
                self._multipliers = np.append(self._multipliers, gained)
                return True
            del self._held[release], self._sides[release]
            self._multipliers = np.delete(self._multipliers, release)

    def _split(self, normal: Array) -> tuple[Array, Array]:
        """Coefficients of `normal` in the held normals, and the part of it that they do not span."""
        if not self._held:
            return np.zeros(0), normal
        normals = -np.array(self._sides)[:, None] * self._rows[self._held]
        pull = np.asarray(np.linalg.lstsq(normals.T, normal, rcond=None)[0])
        return pull, normal - normals.T @ pull

    def _rounding_of(self, pull: Array) -> float:
        """By how much a row that is a combination `pull` of the held ones may miss its bound.

        Bounds that meet in one point but for rounding, `EMPTY_INTERVAL` of each, contradict each other by
        no more than the combination of what rounding there is.
        """
        size = max(1.0, float(np.max(np.abs(self._rows @ self._z))))
        return EMPTY_INTERVAL * size * (1.0 + float(np.sum(np.abs(pull))))

    def _first_released(self, pull: Array) -> tuple[int, float]:
        """Held row whose multiplier reaches 0 first, and the step at which it does."""
        falling = pull > 0.0
        if not np.any(falling):
            return -1, np.inf
        steps = np.full(pull.shape, np.inf)
        steps[falling] = self._multipliers[falling] / pull[falling]
        index = int(np.argmin(steps))
        return index, float(max(steps[index], 0.0))

    def _active(self) -> NDArray[np.int8]:
        active = np.zeros(len(self._rows), dtype=np.int8)
        active[self._held] = np.array(self._sides, dtype=np.int8)
        return active

    def _solution(self) -> QpSolution:
        """z afresh from the rows held, free of what the steps added up."""
        if self._held:
            held = self._rows[self._held]
            sides = np.array(self._sides)
            values = np.where(sides > 0.0, self._upper[self._held], self._lower[self._held])
            self._z = np.asarray(np.linalg.lstsq(held, values, rcond=None)[0])
        reached = self._rows @ self._z
        excess = np.maximum(reached - self._upper, self._lower - reached)
        # Held rows may have changed since rows that met with them were passed over.
        met = all(
            excess[row] <= self._rounding_of(self._split(self._rows[row])[0]) for row in self._passed_over
        )
        if not met or float(np.max(excess)) > _LEFT_OUTSIDE * max(1.0, float(np.max(np.abs(reached)))):
            return QpSolution(None, self._active())
        return QpSolution(self._z, self._active())


def _lost(gram: Array, count: int) -> bool:
    """Whether rows of a Gram matrix (k, k) depend on each other: what they ask for would be noise."""
    values = np.linalg.eigvalsh(gram)
    return bool(values[0] < _INDEPENDENT * values[-1]) if count > 1 else not values[0] > 0.0
