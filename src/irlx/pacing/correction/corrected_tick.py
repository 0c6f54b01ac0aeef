"""One tick of a corrected motion: from the posture before to one on the corrected pose."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.correction.approach import TOO_NEAR, Governor, Pace, approach
from irlx.pacing.correction.giving_way import retreat_of
from irlx.pacing.correction.offset_limiter import OffsetLimiter
from irlx.pacing.correction.plan import PlannedRow
from irlx.pacing.correction.tool_offset import corrected_pose, correction_between, twist_of_rate
from irlx.pacing.correction.tool_rates import ToolRates
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.transform.clearance import Clearance, TickClearance
from irlx.transform.criteria.posture import Posture
from irlx.transform.step_bounds import BoundSource, StepBounds, braking_speed
from irlx.transform.tick import TickSolution, TickSolver
from irlx.transform.tick_problem import TickProblem

Array = NDArray[np.float64]

REFINEMENTS = 5
"""Halvings in the search for the farthest pose between that of braking joints and the wanted one."""

SNAP = 1e-11
"""An offset (rad or m) this small that no correction asks for is what rounding left."""

STILL = 1e-13
"""Step of an offset (rad or m) below which it counts as standing."""

SLOW = 1e-7
"""Step of an offset (rad or m) from which on it may brake joint by joint: the tool hardly moves for it."""

_BRAKING = 0.8


class Surroundings(NamedTuple):
    """What ticks are solved with: the robot, its weights (n,), what may move, and the bounds.

    `clearance` is what is kept clear, from the tick on that it begins with.
    """

    solver: TickSolver
    weights: Array
    free: NDArray[np.bool_]
    limiter: OffsetLimiter
    rates: ToolRates
    clearance: Clearance | None = None

    @property
    def kinematics(self) -> Kinematics:
        """The robot's model."""
        return self.solver.kinematics

    @property
    def limits(self) -> JointLimits:
        """Limits of corrections."""
        return self.limiter.limits

    def of_task(self, correction: Array) -> Array:
        """A correction (6,) without what the robot's task leaves out."""
        return np.where(np.isin(np.arange(correction.size), self.kinematics.task.rows), correction, 0.0)


@dataclass(frozen=True)
class Corrected:
    """A corrected robot at a tick: planned row, posture q (n,), and the correction (6,) that its tool has.

    `speed` (n,) is that of the offset q - planned q, `rate` (6,) that of the correction. `bent`: bounds keep
    the posture from being the one nearest to the planned one. `governor`: what kept the correction from its
    request, None where nothing did; `refused`: the joints could not do the step that `approach` asked for.
    """

    row: PlannedRow
    q: Array
    speed: Array
    correction: Array
    rate: Array
    bent: bool = False
    governor: Governor | None = None
    refused: bool = False

    @property
    def offset(self) -> Array:
        """What the correction adds to the planned posture, (n,)."""
        return np.asarray(self.q - self.row.q)

    @property
    def at_rest(self) -> bool:
        """Whether neither correction nor offset is moving."""
        return not (np.any(self.rate) or np.any(self.speed))

    @property
    def as_planned(self) -> bool:
        """Whether nothing of a correction is left."""
        return self.at_rest and not (self.bent or np.any(self.offset) or np.any(self.correction))


def uncorrected(row: PlannedRow) -> Corrected:
    """A robot that stands, or moves, as planned."""
    return Corrected(row, row.q, np.zeros(row.q.size), np.zeros(6), np.zeros(6))


def corrected_tick(before: Corrected, row: PlannedRow, request: Array, around: Surroundings) -> Corrected:
    """The robot one tick later, on its way from the correction it has to the one that is asked for.

    Limits are kept first, then the pose, then what must stay clear, and then the correction goes on.
    """
    clearance, dt = around.clearance, around.limiter.dt
    if clearance is None:
        return _followed(before, row, request, around, None)
    if clearance.begins_far(before.q):
        found = _followed(before, row, request, around, None)
        if not clearance.nears(found.q, dt):
            return found
    keeping = clearance.following_tick(before.q, row.q - before.row.q, dt)
    return _followed(before, row, request, around, keeping)


def _followed(
    before: Corrected, row: PlannedRow, request: Array, around: Surroundings, keeping: TickClearance | None
) -> Corrected:
    if before.as_planned and not np.any(request) and _clear(keeping, row.q - before.q):
        return uncorrected(row)
    pace, dt = _pace(before, around), around.limiter.dt
    wanted = approach(before.correction, before.rate, request, pace, dt)
    if _stands(before, row, wanted.correction, dt) and _clear(keeping, np.zeros(row.q.size)):
        return Corrected(row, before.q, np.zeros(row.q.size), before.correction, np.zeros(6))
    bounds = around.limiter.bounds(before.offset, before.speed, row.lowest, row.highest)
    criterion = _criterion(before, row, wanted.correction, around)
    tick = _Tick(before, row, bounds, criterion, around, keeping, pace)
    found = tick.solved(wanted.correction)
    governor = wanted.governor if np.any(wanted.correction != request) else None
    if found is not None:
        return tick.reached(found, wanted.correction, governor)
    if keeping is not None:
        resting = approach(before.correction, before.rate, before.correction, pace, dt)
        pressed = tick.pressed(resting.correction, wanted.correction, request)
        if pressed is not None:
            return pressed
        tick = replace(tick, keeping=None)
        found = tick.solved(wanted.correction)
        if found is not None:
            return tick.reached(found, wanted.correction, governor)
    held = tick.holding(wanted.correction)
    return tick.nearest(wanted.correction, held)


def _clear(keeping: TickClearance | None, step: Array) -> bool:
    return keeping is None or keeping.kept(step)


def braked_tick(before: Corrected, row: PlannedRow, around: Surroundings) -> Corrected:
    """The robot one tick later, its offset braking as hard as it may.

    A correction that stands stays as it is for as long as there is a posture for it; else it follows.
    """
    bounds = around.limiter.bounds(before.offset, before.speed, row.lowest, row.highest)
    step = around.limiter.braked(before.speed, bounds)
    going = before.speed * around.limiter.dt
    if float(np.max(np.abs(going))) > SLOW and not np.any(before.rate):
        reference = before.q + (row.q - before.row.q) + step
        tick = _Tick(before, row, bounds, Posture(around.weights, reference), around)
        found = tick.solved(before.correction)
        if found is not None:
            held = tick.reached(found, before.correction, None)
            left = float(np.linalg.norm(held.speed)) * around.limiter.dt
            if left <= 0.5 * float(np.linalg.norm(going) + np.linalg.norm(step)):
                return held
    return stepped(before, row, step, around)


def stepped(before: Corrected, row: PlannedRow, step: Array, around: Surroundings) -> Corrected:
    """The robot one tick later, its offset moved by a step (n,)."""
    moving = around.free & (step != 0.0)
    stays = ~moving & (row.q == before.row.q)
    q = np.where(stays, before.q, around.limits.into_positions(row.q + (before.offset + step)))
    speed = np.where(moving, step / around.limiter.dt, 0.0)
    correction = before.correction
    if not np.all(stays):
        correction = correction_between(row.rotation, row.position, around.kinematics.tool_pose(q))
        correction = around.of_task(correction)
    rate = (correction - before.correction) / around.limiter.dt
    return Corrected(row, q, speed, correction, rate, bent=True)


def _stands(before: Corrected, row: PlannedRow, wanted: Array, dt: float) -> bool:
    """Whether nothing is left to move: the plan stands, and the correction, and the offset behind it."""
    same = np.array_equal(row.q, before.row.q) and np.array_equal(wanted, before.correction)
    quiet = float(np.max(np.abs(before.speed))) * dt <= STILL
    return bool(same and quiet and not before.bent)


def movable_joints(around: Surroundings) -> NDArray[np.bool_]:
    """The joints (n,) that are not frozen and that the limits let move both ways."""
    movable = around.free.copy()
    for kind in ("speed", "acceleration"):
        lower, upper = around.limits.pair(kind)
        movable &= (lower < 0.0) & (upper > 0.0)
    return np.asarray(movable)


def _pace(before: Corrected, around: Surroundings) -> Pace:
    """What a change of the correction would ask of the joints that may move."""
    row, limits = before.row, around.limits
    target = corrected_pose(row.rotation, row.position, before.correction)
    _, jacobian = around.kinematics.difference(before.q, target)
    movable = movable_joints(around)
    twists = twist_of_rate(before.correction)[list(around.kinematics.task.rows)]
    rates = np.zeros((movable.size, 6))
    j = jacobian[:, movable]
    scaled = j / around.weights[movable]
    rates[movable] = scaled.T @ (np.linalg.pinv(scaled @ j.T, rcond=1e-12, hermitian=True) @ twists)
    return Pace(rates, limits, around.rates)


def _criterion(before: Corrected, row: PlannedRow, wanted: Array, around: Surroundings) -> Posture:
    """Nearest to the planned posture; where bounds have kept it away, no faster than it can stop there.

    A full pull at a far posture would overshoot under acceleration bounds, and ring.
    """
    if not before.bent:
        return Posture(around.weights, row.q)
    target = corrected_pose(row.rotation, row.position, wanted)
    nothing = np.full(row.q.size, np.inf)
    unbound = StepBounds(-nothing, nothing)
    ideal = Posture(around.weights, row.q)
    problem = TickProblem(target, before.q, unbound, ideal, around.free)
    found = around.solver.solve(problem, row.q - before.row.q, thorough=False)
    if not found.solved:
        return ideal
    away = found.q - row.q - before.offset
    room, dt = np.abs(away), around.limiter.dt
    limits = around.limits
    able = np.minimum(-limits.acceleration_lower, limits.acceleration_upper)
    step = dt * braking_speed(room, _BRAKING * able, dt)
    step = np.minimum(step, dt * np.where(away > 0.0, limits.speed_upper, -limits.speed_lower))
    shares = np.divide(step, room, out=np.ones(room.size), where=(room > step) & around.free)
    share = float(np.min(shares))
    return ideal if share >= 1.0 else Posture(around.weights, row.q + before.offset + share * away)


@dataclass(frozen=True)
class _Tick:
    """A tick that is being solved: `bounds` of the step of the offset, `criterion` of the posture.

    `keeping` are the floors of what is near; with `pace` a correction must also be able to stop before it.
    """

    before: Corrected
    row: PlannedRow
    bounds: StepBounds
    criterion: Posture
    around: Surroundings
    keeping: TickClearance | None = None
    pace: Pace | None = None

    @property
    def planned_step(self) -> Array:
        """What the plan itself moves in this tick, (n,)."""
        return np.asarray(self.row.q - self.before.row.q)

    def problem(self, correction: Array) -> TickProblem:
        """The tick with a pose corrected by `correction` (6,)."""
        move, bounds = self.planned_step, self.bounds
        return TickProblem(
            corrected_pose(self.row.rotation, self.row.position, correction),
            self.before.q,
            StepBounds(move + bounds.lower, move + bounds.upper, find_sources=lambda: bounds),
            self.criterion,
            self.around.free,
            None if self.keeping is None else self.keeping.again(),
        )

    def solved(self, correction: Array) -> TickSolution | None:
        """The posture of a corrected pose, None where the bounds leave none."""
        seed = self.planned_step + self.before.speed * self.around.limiter.dt
        found = self.around.solver.solve(self.problem(correction), seed, thorough=False)
        return found if found.solved and self._stops_in_time(found.q, correction) else None

    def _stops_in_time(self, q: Array, correction: Array) -> bool:
        """Whether a correction (6,) that goes on as it came in this tick can still brake before a margin."""
        rate = (correction - self.before.correction) / self.around.limiter.dt
        speed = float(np.linalg.norm(rate))
        if self.keeping is None or self.pace is None or speed == 0.0:
            return True
        able, _ = self.pace.acceleration(-rate / speed)
        braking = speed / (2.0 * _BRAKING * able) + self.around.limiter.dt
        further = self.pace.joint_rates @ (rate * braking)
        return self.keeping.again().stays_clear(q - self.before.q, further)

    def reached(
        self, found: TickSolution, correction: Array, governor: Governor | None, refused: bool = False
    ) -> Corrected:
        """The robot in the posture of a solution whose tool has `correction` (6,)."""
        before, row, dt = self.before, self.row, self.around.limiter.dt
        q = self.around.limits.into_positions(found.q)
        if not np.any(correction) and np.max(np.abs(q - row.q)) <= SNAP:
            q = np.where(self.around.free & self._may_step(row.q), row.q, q)
        elif np.array_equal(row.q, before.row.q) and np.max(np.abs(q - before.q)) <= STILL:
            q = np.where(self._may_step(before.q), before.q, q)
        step = np.where(self.around.free, q - row.q - before.offset, 0.0)
        rate = (correction - before.correction) / dt
        bent = refused or bool(np.any(found.active)) or self._pulled_back(row)
        bent = bent or (self.keeping is not None and bool(np.any(q != row.q)))
        return Corrected(row, q, step / dt, correction, rate, bent, governor, refused)

    def _may_step(self, q: Array) -> NDArray[np.bool_]:
        step = q - self.row.q - self.before.offset
        return np.asarray((step >= self.bounds.lower) & (step <= self.bounds.upper))

    def _pulled_back(self, row: PlannedRow) -> bool:
        return self.criterion.reference is not row.q

    def pressed(self, resting: Array, wanted: Array, request: Array) -> Corrected | None:
        """The tick where something would come too near on the way to a correction `wanted` (6,).

        What lies between `resting`, the correction that stands or brakes, and the wanted one is kept clear
        where that goes; else the posture leaves the margin as fast as it may. None where bounds leave no
        posture at all.
        """
        governor = TOO_NEAR if np.any(resting != request) else None
        braking = replace(self, pace=None)
        if np.any(resting != wanted):
            first = braking.solved(resting)
            if first is not None:
                found = self._farthest(resting, wanted) or (first, resting)
                return self.reached(*found, TOO_NEAR, refused=True)
        if self.keeping is not None and np.any(resting != self.before.correction):
            # It brakes as hard as it may, and had been let go so fast that this is enough.
            first = replace(braking, keeping=self.keeping.at_margins()).solved(resting)
            if first is not None:
                return self.reached(first, resting, TOO_NEAR, refused=True)
        return self._giving_way(resting, governor)

    def _giving_way(self, correction: Array, governor: Governor | None) -> Corrected | None:
        """The tick in which the posture leaves what is too near as fast as it may; other pairs stay clear."""
        if self.keeping is None:
            return None
        around, base = self.around, self.planned_step
        # What was far before the tick counts from here on.
        self.keeping.kept(base)
        retreat = retreat_of(self.problem(correction), around.kinematics, around.weights, base)
        criterion = Posture(around.weights, self.before.q + base + retreat.step)
        for keeping in (self.keeping.without(retreat.pairs), None):
            tick = replace(self, criterion=criterion, keeping=keeping, pace=None)
            found = tick.solved(correction)
            if found is not None:
                return tick.reached(found, correction, governor, refused=governor is not None)
        return None

    def holding(self, wanted: Array) -> Governor:
        """The bound that keeps the offset from a step towards a correction (6,) the most."""
        problem = self.problem(wanted)
        _, step = self.around.solver.newton_problem(problem, np.zeros(self.row.q.size))
        free = np.flatnonzero(problem.free)
        lower, upper = problem.bounds.lower[free], problem.bounds.upper[free]
        over = np.maximum(step - upper, lower - step) / np.maximum(upper - lower, 1e-300)
        worst = int(np.argmax(over))
        sources = self.bounds.upper_source if step[worst] > upper[worst] else self.bounds.lower_source
        return Governor(int(free[worst]), BoundSource(sources[free[worst]]))

    def nearest(self, wanted: Array, held: Governor) -> Corrected:
        """The farthest pose there is between that of joints that brake and the wanted one."""
        braked = stepped(
            self.before, self.row, self.around.limiter.braked(self.before.speed, self.bounds), self.around
        )
        best = self._farthest(braked.correction, wanted)
        if best is None:
            return Corrected(
                braked.row, braked.q, braked.speed, braked.correction, braked.rate, True, held, True
            )
        return self.reached(*best, held, refused=True)

    def _farthest(self, near: Array, far: Array) -> tuple[TickSolution, Array] | None:
        """The farthest correction (6,) from `near` to `far` that has a posture, beyond `near` itself."""
        low, high = 0.0, 1.0
        best: tuple[TickSolution, Array] | None = None
        for _ in range(REFINEMENTS):
            share = 0.5 * (low + high)
            between = near + share * (far - near)
            found = self.solved(between)
            if found is None:
                high = share
            else:
                low, best = share, (found, between)
        return best
