"""First posture for every knot: the local law, its joint bounds stretched where they must be.

Between two knots the step D of the joints may be as long as speeds and the way to position limits allow
in the programmed time. Where no step on the path is that short, *one* number eps >= 0 stretches all bounds
alike: it is the local loss of time, and it is paid for together with the motion,

    min 1/2 (D - D_c)' (W / dT^2) (D - D_c) + nu (eps + eps^2 / 2000),   -dn (1 + eps) <= D <= up (1 + eps),

D_c the criterion's own step. Hard bounds instead would whip the null space about. Positions are never
stretched. Accelerations play no part here: the clock sees to them.

What CRITERION adds to D_c is held to |D_c'|_W <= dT |u|_W, u being the speeds that the joints can come to in
the motion. As u <= v and nu = |v|_W^2 no such wish pays for a stretch: a unit of it is worth (W D_c')' v / dT
at most, by Cauchy and Schwarz no more than nu. Without this a joint on a limit, where JOINT_BARRIER has a
slope of 1e6, made a move of 10 ms last for minutes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import prod, sqrt

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.slowdown.grid import PathGrid
from irlx.pacing.slowdown.model import Model
from irlx.pacing.slowdown.reserve import rounded_inside
from irlx.pacing.slowdown.room import Room
from irlx.robot.limits import JointLimits
from irlx.transform.clearance import SideRows, TickClearance
from irlx.transform.compact import null_space_rows
from irlx.transform.criteria.criterion import Criterion
from irlx.transform.qp.dual import DualSolver
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.rough_tick import RoughTickSolver
from irlx.transform.tick import TickSolution, TickSolver
from irlx.transform.tick_problem import TickProblem

Array = NDArray[np.float64]

_ROUNDS = 12
_SETTLED = 1e-6
_COARSELY_SETTLED = 3e-5
_NO_SLOPE = 1e-14
_ROUNDING = 1e-12
_CURVATURE = 1e-3
_LONGEST = 0.5


@dataclass(frozen=True)
class Passage:
    """Postures q (N + 1, n) of the knots and the stretch (N,) of each interval's bounds.

    `stopped` is None, or the interval that no step crosses and how it ended there, which would have been
    `elapsed` s after the begin of the motion.
    """

    q: Array
    stretch: Array
    stopped: tuple[int, TickSolution] | None = None
    elapsed: float = 0.0


def elastic_walk(
    model: Model,
    grid: PathGrid,
    start: Array,
    criterion_of: Callable[[float, float], Criterion],
    bounds: tuple[Array, Array],
    reserve: float,
    coarse: bool = False,
) -> Passage:
    """Walk from posture `start` (n,) along the knots of a grid.

    `criterion_of` gives the criterion for a path parameter and the way to it, `bounds` the lower and upper
    positions (N + 1, n) of the knots; a joint outside them comes back by `reserve` / 12 an interval.
    `coarse`: postures only as near to the best ones as a dry run needs.
    """
    steps = _Steps(model, reserve, coarse)
    wish = _largest_wish(model, float(np.sum(grid.times)))
    targets = model.targets(grid.poses)
    q = np.empty((grid.intervals + 1, start.size))
    stretch = np.zeros(grid.intervals)
    q[0] = start
    elapsed = 0.0
    for i in range(grid.intervals):
        room = Room.at(model, q[i], (bounds[0][i + 1], bounds[1][i + 1]), reserve, float(grid.times[i]))
        criterion = criterion_of(float(grid.s[i + 1]), float(grid.s[i + 1] - grid.s[i])).begun(q[i])
        criterion = criterion.asking_at_most(room.duration * wish)
        keeping = _kept_clear(model, q[i], room.duration, elapsed, reserve)
        problem = TickProblem(targets[i + 1], q[i], room.none(), criterion, model.free, keeping)
        found = steps.step(problem, room, _continued(grid.s, q, i), elapsed)
        if isinstance(found, TickSolution):
            return Passage(q[: i + 1], stretch[:i], (i, found), elapsed + room.duration)
        q[i + 1] = rounded_inside(q[i] + found[0], model.limits)
        stretch[i] = found[1]
        elapsed += room.duration * (1.0 + found[1])
    return Passage(q, stretch)


def _speeds(limits: JointLimits) -> Array:
    """Speeds (n,) that joints may have in both directions, 1 rad/s or m/s where there is no limit."""
    speed = np.minimum(limits.speed_upper, -limits.speed_lower)
    return np.where(np.isfinite(speed), speed, 1.0)


def _largest_wish(model: Model, duration: float) -> float:
    """|u|_W, inf where no joint is limited: u what joints come to from rest in half of `duration` s."""
    limits = model.limits
    acceleration = np.minimum(limits.acceleration_upper, -limits.acceleration_lower)
    if not np.any(np.isfinite([acceleration, limits.speed_upper, limits.speed_lower])):
        return np.inf
    reached = np.minimum(_speeds(limits), 0.5 * duration * acceleration)
    return sqrt(float(model.weights @ reached**2))


class _Steps:
    """Steps from knot to knot; what held joints in the one before tells how the next one is sought."""

    def __init__(self, model: Model, reserve: float, coarse: bool) -> None:
        self._model, self._reserve = model, reserve
        self._solver = (RoughTickSolver if coarse else TickSolver)(model.kinematics, ProxQpSolver())
        self._settled = _COARSELY_SETTLED if coarse else _SETTLED
        self._held = False
        self._active: NDArray[np.int8] | None = None

    def step(
        self, problem: TickProblem, room: Room, continued: Array, elapsed: float
    ) -> tuple[Array, float] | TickSolution:
        """Step (n,) of an interval `elapsed` s after the begin, and its stretch; else how it ended.

        `continued` (n,) is where the postures before lead to.
        """
        easy = self._easy(problem, room, continued)
        if easy is not None:
            return easy, 0.0
        elastic = _Stretch(self._model, self._solver, problem, room, self._settled, self._active)
        found = elastic.solve(continued)
        if found is None:
            found = elastic.solve(np.zeros(problem.q.size))
        if found is None and problem.clearance is not None:
            # How fast the path itself leads near something is for the clock: the margins are left.
            keeping = _kept_clear(self._model, problem.q, room.duration, elapsed, self._reserve, False)
            problem = problem._replace(clearance=keeping)
            elastic = _Stretch(self._model, self._solver, problem, room, self._settled)
            found = elastic.solve(np.zeros(problem.q.size))
        if found is None:
            last = self._solver.solve(problem._replace(bounds=room.positions()))
            if not last.solved:
                return last
            found = last.q - problem.q, room.stretch_of(last.q - problem.q)
        self._held, self._active = not room.is_wide_for(found[0]), elastic.active
        return found

    def _easy(self, problem: TickProblem, room: Room, continued: Array) -> Array | None:
        """A step that needs no stretch, where one is likely."""
        if isinstance(self._solver, RoughTickSolver):
            inside = self._solver.at_once(problem._replace(bounds=room.unstretched()), continued)
            if isinstance(inside, TickSolution):
                return inside.q - problem.q
        if self._held:
            return None
        easy = self._solver.solve(problem, continued, thorough=False)
        step = easy.q - problem.q
        return step if easy.solved and room.holds(step) else None


def _continued(s: Array, q: Array, last: int) -> Array:
    """Step (n,) behind the knot `last` that continues the knots up to it as a cubic."""
    first = max(last - 3, 0)
    *known, at = s[first : last + 2].tolist()
    shares = [prod((b - at) / (b - a) for b in known if b != a) for a in known]
    return np.asarray(np.array(shares) @ q[first : last + 1] - q[last])


class _Stretch:
    """The elastic quadratic problem of one interval, iterated until the pose is met."""

    def __init__(
        self,
        model: Model,
        solver: TickSolver,
        problem: TickProblem,
        room: Room,
        settled: float,
        active: NDArray[np.int8] | None = None,
    ) -> None:
        self._model, self._solver, self._room, self._settled = model, solver, room, settled
        self._problem = problem
        self.active = active
        """Rows held in the last round; those of the interval before are a good guess."""
        # A price in the units of the motion's own cost: one unit of stretch costs the motion at all limits.
        self._price = max(float(model.weights @ _speeds(model.limits) ** 2), 1e-12)

    def solve(self, begin: Array) -> tuple[Array, float] | None:
        """Whole step (n,) and its stretch, searched from `begin`; None where none meets the pose."""
        whole = begin
        for _ in range(_ROUNDS):
            moved = self._round(whole)
            if moved is None:
                return None
            step, stretch = moved
            if not np.isfinite(step).all():
                return None
            change = step - whole
            largest = float(np.abs(change).max(initial=0.0))
            whole = whole + change * min(1.0, _LONGEST / max(largest, 1e-300))
            if largest <= self._settled:
                # Where joints are held a step may be small without leading anywhere.
                left, _ = self._model.kinematics.difference(self._problem.q + whole, self._problem.target)
                if float(np.abs(left).max()) > _SETTLED:
                    return None
                keeping = self._problem.clearance
                if keeping is None or keeping.kept(whole):
                    return whole, stretch
        return None

    def _round(self, whole: Array) -> tuple[Array, float] | None:
        free, room = self._model.free, self._room
        problem, d_free = self._solver.newton_problem(self._problem, whole)
        rows = null_space_rows(problem) * room.duration
        sides = None
        if problem.sides is not None:
            matrix = problem.sides.matrix
            sides = SideRows(matrix @ rows, problem.sides.lower - matrix @ d_free)
        asked = rows, whole[free] + d_free, _reduced(room, free), self._price, sides
        found = _one_unknown(*asked) if rows.shape[1] == 1 else self._many_unknowns(*asked)
        if found is None:
            return None
        step = np.zeros(whole.size)
        step[free] = found[0]
        return step, found[1]

    def _many_unknowns(
        self, rows: Array, target: Array, room: Room, price: float, sides: SideRows | None
    ) -> tuple[Array, float] | None:
        found, self.active = _many_unknowns(rows, target, room, price, sides, self.active)
        return found


def _reduced(room: Room, free: NDArray[np.bool_]) -> Room:
    return Room(room.low[free], room.high[free], room.down[free], room.up[free], room.duration)


def _many_unknowns(
    rows: Array,
    target: Array,
    room: Room,
    price: float,
    sides: SideRows | None,
    guess: NDArray[np.int8] | None,
) -> tuple[tuple[Array, float] | None, NDArray[np.int8]]:
    """Minimise 1/2 |z|^2 + price (eps + eps^2 / 2000), D = target + rows z; D and eps, and the rows held.

    With e = scale (eps + offset) the price is half a square, and all is a least-norm problem in (z, e).
    `sides` are inequalities of z that are kept whatever the price; `guess` the rows held in a problem alike.
    """
    count, unknowns = rows.shape
    scale, offset = np.sqrt(_CURVATURE * price), 1.0 / _CURVATURE
    above, below = np.flatnonzero(np.isfinite(room.up)), np.flatnonzero(np.isfinite(room.down))
    size = count + above.size + below.size + 1
    matrix = np.zeros((size, unknowns + 1))
    lower, upper = np.full(size, -np.inf), np.full(size, np.inf)
    matrix[:count, :unknowns] = rows
    lower[:count], upper[:count] = room.low - target, room.high - target
    first, second = slice(count, count + above.size), slice(count + above.size, size - 1)
    matrix[first, :unknowns], matrix[first, unknowns] = rows[above], -room.up[above] / scale
    upper[first] = room.up[above] * (1.0 - offset) - target[above]
    matrix[second, :unknowns], matrix[second, unknowns] = rows[below], room.down[below] / scale
    lower[second] = -room.down[below] * (1.0 - offset) - target[below]
    matrix[-1, unknowns], lower[-1] = 1.0, scale * offset
    if sides is not None:
        matrix = np.vstack([matrix, np.pad(sides.matrix, ((0, 0), (0, 1)))])
        lower = np.concatenate([lower, sides.lower])
        upper = np.concatenate([upper, np.full(len(sides.lower), np.inf)])
    known = guess if guess is not None and len(guess) == len(lower) else None
    found = DualSolver().solve(matrix, lower, upper, known)
    z = found.z
    if z is None:
        return None, found.active
    step = target + rows @ z[:unknowns]
    return (step, max(float(z[unknowns]) / scale - offset, 0.0)), found.active


def _kept_clear(
    model: Model, q: Array, duration: float, elapsed: float, reserve: float, paced: bool = True
) -> TickClearance | None:
    """What a step from posture q (n,) in `duration` s must keep clear, with the reserve of a plan (m)."""
    clearance = model.clearance
    return None if clearance is None else clearance.tick(q, duration, elapsed, reserve, paced)


def _within_sides(sides: SideRows, least: float, most: float) -> tuple[float, float]:
    """Smallest and largest value of the one unknown that keeps the inequalities; crossed where none does."""
    for slope, bound in zip(sides.matrix[:, 0].tolist(), sides.lower.tolist(), strict=True):
        if abs(slope) <= _NO_SLOPE:
            if bound > _ROUNDING:
                return np.inf, -np.inf
        elif slope > 0.0:
            least = max(least, bound / slope)
        else:
            most = min(most, bound / slope)
    return least, most


def _one_unknown(
    rows: Array, target: Array, room: Room, price: float, sides: SideRows | None
) -> tuple[Array, float] | None:
    """`_many_unknowns` where there is but one."""
    slope = rows[:, 0]
    still = np.abs(slope) <= _NO_SLOPE
    if (still & ((target > room.high + _ROUNDING) | (target < room.low - _ROUNDING))).any():
        return None
    safe = np.where(still, 1.0, slope)
    first, second = (room.low - target) / safe, (room.high - target) / safe
    least = float(np.where(still, -np.inf, np.minimum(first, second)).max())
    most = float(np.where(still, np.inf, np.maximum(first, second)).min())
    if sides is not None:
        least, most = _within_sides(sides, least, most)
    if least > most:
        return None
    # Stretch as straight lines in z: nothing, and what each bound asks for.
    above, below = np.isfinite(room.up) & (room.up > 0.0), np.isfinite(room.down) & (room.down > 0.0)
    at = np.concatenate(
        [[0.0], target[above] / room.up[above] - 1.0, -target[below] / room.down[below] - 1.0]
    )
    rise = np.concatenate([[0.0], slope[above] / room.up[above], -slope[below] / room.down[below]])
    z, stretch = _least_cost(at, rise, price, least, most)
    return target + slope * z, stretch


def _least_cost(at: Array, rise: Array, price: float, least: float, most: float) -> tuple[float, float]:
    """z in [least, most] with the least 1/2 z^2 + price (e + e^2 / 2000), e = max(at + rise z), and that e.

    The cost is convex and made of parabolas, one a line. Its least value is that of the higher one of two
    lines, one on either side of it, once no third line is above them there.
    """
    own = -price * rise * (1.0 + _CURVATURE * at) / (1.0 + price * _CURVATURE * rise**2)
    own = np.minimum(np.maximum(own, least), most)
    left = right = -1
    z = min(max(0.0, least), most)
    for _ in range(len(at)):
        heights = at + rise * z
        line = int(heights.argmax())
        if line in (left, right):
            break
        if z + price * rise[line] * (1.0 + _CURVATURE * heights[line]) < 0.0:
            left = line
        else:
            right = line
        if left < 0 or right < 0:
            z = float(own[line])
        else:
            meet = (at[left] - at[right]) / (rise[right] - rise[left])
            z = float(min(own[left], max(own[right], min(max(meet, least), most))))
    return z, float((at + rise * z).max())
