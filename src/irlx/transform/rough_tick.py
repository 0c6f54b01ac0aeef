"""Ticks of a dry run: the same step as that of `TickSolver`, to a thousandth of a degree and for less.

From one row to the next hardly ever another bound comes to hold a joint. So each Newton step begins with what
held in the last tick, and changes that by one bound after another for as long as a joint passes a bound, or
a bound pulls where it should push: then it meets the conditions of Karush, Kuhn and Tucker, and is *the*
solution of the step. Where that leads to nothing, the tick is solved as in a run, with all precautions.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dposv

from irlx.robot.kinematics import Kinematics
from irlx.transform.clearance import SideRows
from irlx.transform.criterion_pace import CriterionPace
from irlx.transform.precision import MAX_NEWTON_STEP
from irlx.transform.qp.solver import QpSolver
from irlx.transform.tick import TickSolution, TickSolver, TickStatus
from irlx.transform.tick_problem import TickProblem

Array = NDArray[np.float64]
Sides = NDArray[np.int8]

SETTLED = 3e-5
"""Length (rad and m) of the Newton step that is the last one: the pose is met to about its square."""

MET = 1e-5
"""Pose error (m or rad) before the last step."""

_ROUNDS = 20
_SLACK = 1e-10
_PULL = 1e-9
_LEFT = 1e-8


class RoughTickSolver(TickSolver):
    """Solves ticks to `SETTLED`. Holds which bounds the last tick met, as a guess that decides nothing."""

    runs_free = False

    def __init__(self, kinematics: Kinematics, qp: QpSolver) -> None:
        super().__init__(kinematics, qp)
        self._side: Sides = np.zeros(kinematics.joints, dtype=np.int8)
        self._pairs: frozenset[int] = frozenset()

    def solve(self, problem: TickProblem, seed: Array | None = None, thorough: bool = True) -> TickSolution:
        """As `TickSolver.solve`; where a few steps find nothing, that itself, without the seed."""
        found = self.at_once(problem, np.zeros(problem.q.size) if seed is None else seed)
        if isinstance(found, TickSolution):
            return found
        if found is TickStatus.NO_STEP and not thorough:
            # Something holds: no need to begin without any bounds.
            begun = problem._replace(criterion=problem.criterion.begun(problem.q))
            careful = self._newton(begun, np.zeros(problem.q.size))
            if isinstance(careful, TickSolution):
                return careful
            nothing = np.zeros(problem.q.size, dtype=np.int8)
            return TickSolution(careful, problem.q, nothing, self._no_rows(), self._max_iterations)
        return super().solve(problem, None, thorough)

    def at_once(self, problem: TickProblem, seed: Array) -> TickSolution | TickStatus:
        """The tick, searched from the step `seed` (n,); else why a few Newton steps do not find it.

        NO_STEP where the bounds that hold leave too few joints for the pose.
        """
        q, free, criterion = problem.q, problem.free, problem.criterion.begun(problem.q)
        lower, upper = problem.bounds.lower, problem.bounds.upper
        if np.count_nonzero(lower > upper):
            return TickStatus.BOUNDS_CONFLICT
        inside = np.minimum(np.maximum(seed, lower), upper)
        whole = np.where(free, inside, 0.0)
        side = self._side * (free & np.isfinite(np.where(self._side > 0, upper, lower)))
        pairs, keeping = self._pairs, problem.clearance
        hessian, pace = criterion.hessian(), CriterionPace()
        for iteration in range(1, _ROUNDS + 1):
            twist, jacobian = self.kinematics.difference(q + whole, problem.target)
            step = _Step(
                jacobian, twist, criterion.pull(q, whole), hessian, lower - whole, upper - whole, free
            )
            if keeping is not None and len(keeping.near.pairs):
                step.keep(keeping.rows(whole), keeping.near.pairs, pairs)
            d = step.solved(side)
            if d is None:
                return TickStatus.NO_STEP if step.is_overheld else TickStatus.NOT_CONVERGED
            side, pairs, size = step.side, step.held_pairs, sqrt(d.dot(d))
            if not size <= MAX_NEWTON_STEP:
                return TickStatus.NOT_CONVERGED
            done = size <= SETTLED and twist.dot(twist) <= MET**2
            whole = whole + (d if done else _shaped(step, d, pace, twist, hessian))
            whole = np.where(side > 0, upper, np.where(side < 0, lower, whole))
            if done:
                whole = np.where(free, np.minimum(np.maximum(whole, lower), upper), 0.0)
                if keeping is not None and not keeping.kept(whole):
                    return TickStatus.TOO_NEAR
                self._side, self._pairs = side, pairs
                reached = np.where(free, q + whole, q)
                return TickSolution(TickStatus.SOLVED, reached, side, twist, iteration)
        return TickStatus.NOT_CONVERGED


def _shaped(step: _Step, d: Array, pace: CriterionPace, twist: Array, hessian: Array) -> Array:
    """The step d (n,) with the share of its part along the null space that the path's bend asks for."""
    share, taken = pace.share(twist, hessian, d), d
    along = step.along_path() if share != 1.0 else None
    if along is not None:
        shared = along + share * (d - along)
        taken = shared if step.holds(shared) else d
    pace.took(twist, d, taken)
    return taken


class _Step:
    """A Newton step: min 1/2 (d - p)' H (d - p),  J d = e,  low <= d <= up,  A d >= b, d of frozen joints 0.

    `pull` p (n,), `hessian` H as (n,) or (n, n). What holds: `side` (n,), +1 / -1 at the upper / lower bound,
    and the rows of A in `_rows`.
    """

    def __init__(
        self,
        jacobian: Array,
        twist: Array,
        pull: Array,
        hessian: Array,
        low: Array,
        up: Array,
        free: NDArray[np.bool_],
    ) -> None:
        self._jacobian, self._twist, self._pull, self._hessian = jacobian, twist, pull, hessian
        self._low, self._up, self._free = low, up, free
        self.side: Sides = np.zeros(pull.size, dtype=np.int8)
        self._sides: SideRows | None = None
        self._numbers: NDArray[np.intp] = np.zeros(0, dtype=np.intp)
        self._rows: list[int] = []

    def keep(self, sides: SideRows, numbers: NDArray[np.intp], held: frozenset[int]) -> None:
        """Add inequalities of pairs by their numbers (P,); those of the pairs in `held` hold at first."""
        self._sides, self._numbers = sides, numbers
        self._rows = [row for row, number in enumerate(numbers.tolist()) if number in held]

    @property
    def held_pairs(self) -> frozenset[int]:
        """Numbers of the pairs whose inequality holds."""
        return frozenset(self._numbers[self._rows].tolist())

    @property
    def is_overheld(self) -> bool:
        """Whether fewer joints are left to move than the pose has coordinates."""
        moving = np.count_nonzero(self._free & (self.side == 0))
        return int(moving) < len(self._twist) + len(self._rows) <= int(np.count_nonzero(self._free))

    def solved(self, side: Sides) -> Array | None:
        """The step (n,), begun with bounds that hold by a guess; None where none is found.

        A guess that leads to nothing is forgotten.
        """
        found = self._exchanged(side)
        if found is None and (np.count_nonzero(side) or self._rows):
            self._rows = []
            found = self._exchanged(np.zeros_like(side))
        return found

    def _exchanged(self, side: Sides) -> Array | None:
        self.side = side.copy()
        for _ in range(3 * side.size):
            found = self._held(self._pull)
            if found is None:
                return None
            d, bound_pull, row_pull = found
            if self._let_go(bound_pull, row_pull) or self._take_in(d):
                continue
            return d
        return None

    def along_path(self) -> Array | None:
        """The shortest step that meets the pose, with what holds now."""
        found = self._held(np.zeros_like(self._pull))
        return None if found is None else found[0]

    def holds(self, d: Array) -> bool:
        """Whether a step (n,) keeps all bounds and rows."""
        kept = (self._low - _SLACK <= d) & (d <= self._up + _SLACK) | ~self._free
        return bool(np.all(kept)) and (self._sides is None or self._sides.hold(d))

    def _held(self, pull: Array) -> tuple[Array, Array, Array] | None:
        """Step with what holds now; how much bounds (n,) and rows pull, negative where they push."""
        moving, held = self._free & (self.side == 0), self.side != 0
        d = np.where(held, np.where(self.side > 0, self._up, self._low), 0.0)
        rows, asked = self._jacobian, self._twist
        if self._sides is not None and self._rows:
            rows = np.vstack([rows, self._sides.matrix[self._rows]])
            asked = np.concatenate([asked, self._sides.lower[self._rows]])
        hessian = self._hessian
        if hessian.ndim == 1:
            scaled = rows * (moving / hessian)
            d = d + moving * pull
        else:
            inverse = np.zeros_like(hessian)
            some = np.ix_(moving, moving)
            inverse[some] = np.linalg.inv(hessian[some])
            scaled = rows.dot(inverse)
            fixed = np.where(moving, 0.0, d - pull)
            d = np.where(moving, pull - inverse.dot(hessian.dot(fixed)), d)
        _, k, failed = dposv(scaled.dot(rows.T), asked - rows.dot(d))
        if failed:
            return None
        d = d + k.dot(scaled)
        left = asked - rows.dot(d)
        if not left.dot(left) <= _LEFT**2 * (1.0 + asked.dot(asked)):
            # The joints that move cannot do it, and rounding hid that.
            return None
        along = d - pull
        slope = (hessian * along if hessian.ndim == 1 else hessian.dot(along)) - k.dot(rows)
        return d, self.side * slope, -k[len(self._twist) :]

    def _take_in(self, d: Array) -> bool:
        """Hold what a step passes most; False where it passes nothing."""
        over = np.maximum(d - self._up, self._low - d)
        over[self.side != 0] = -np.inf
        over[~self._free] = -np.inf
        joint = int(over.argmax())
        worst, row = float(over[joint]), -1
        if self._sides is not None:
            lacking = self._sides.lower - self._sides.matrix.dot(d)
            lacking[self._rows] = -np.inf
            if len(lacking) and float(lacking.max()) > max(worst, _SLACK):
                row = int(lacking.argmax())
        if row >= 0:
            self._rows.append(row)
            return True
        if worst <= _SLACK:
            return False
        self.side[joint] = 1 if d[joint] > self._up[joint] else -1
        return True

    def _let_go(self, bound_pull: Array, row_pull: Array) -> bool:
        """Let go of what pulls most; False where all that holds pushes."""
        size = float(np.max(np.abs(bound_pull), initial=0.0))
        joint = int(bound_pull.argmax())
        if bound_pull[joint] > _PULL * max(size, 1e-6):
            self.side[joint] = 0
            return True
        if len(row_pull) and float(row_pull.max()) > _PULL:
            del self._rows[int(row_pull.argmax())]
            return True
        return False
