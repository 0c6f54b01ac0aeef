"""Corrects the rows of a program tick by tick, as a sensor asks for it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from irlx.blocks import Block
from irlx.diagnostics import Diagnostic, IrlxError, Place, report
from irlx.pacing.correction.corrected_tick import (
    Corrected,
    Surroundings,
    braked_tick,
    corrected_tick,
    movable_joints,
    stepped,
    uncorrected,
)
from irlx.pacing.correction.nearness import Nearness, NearPair
from irlx.pacing.correction.offset_limiter import OffsetLimiter
from irlx.pacing.correction.placements import read_placements
from irlx.pacing.correction.plan import PlannedMotion, PlannedRow, goes_on, planned_motion
from irlx.pacing.correction.request import SIZE, read_request
from irlx.pacing.correction.retreat import AT_GOAL, retreat_goal, retreat_step
from irlx.pacing.correction.share import correction_limits
from irlx.pacing.correction.tally import Tally
from irlx.pacing.correction.tool_offset import corrected_pose, correction_between
from irlx.pacing.correction.tool_rates import ToolRates
from irlx.pacing.errors import PacingError
from irlx.pacing.executed import Executed
from irlx.pacing.frames import frame_of
from irlx.pacing.impossible import joint_value
from irlx.pacing.pacer import Pacer
from irlx.promises import PATH_ORIENTATION, PATH_POSITION
from irlx.robot.limits import JointLimits
from irlx.scene.trajectory import way_of
from irlx.transform.tick import TickSolver

Array = NDArray[np.float64]

NEWTON_STEPS = 15
"""Newton steps of a tick before its pose counts as out of reach: there is a nearer one then."""


class CorrectedRow(NamedTuple):
    """A row to emit: posture (n,), rotation (3, 3) and position (3,) m of the tool, its block, correction.

    `nearest` is what comes nearest to its margin, None where everything is far.
    """

    q: Array
    rotation: Array
    position: Array
    block: Block
    correction: Array
    nearest: NearPair | None = None


@dataclass(frozen=True)
class Senses:
    """What is known of the world while a program runs: each answers to the row that was emitted last.

    `ask` the correction that the tool is to have, `look` where obstacles are; None where nobody says it.
    """

    ask: Callable[[], object] | None = None
    look: Callable[[], object] | None = None


class Corrector:
    """Follows the rows that a pacer has planned with less than the whole limits (`share.py`).

    It adds corrections, and makes room for obstacles that are seen; `tally` and `nearness` count what becomes
    of it. A tick that the robot has to stand for is added to the clock of the pacer.
    """

    def __init__(
        self, pacer: Pacer, rates: ToolRates, senses: Senses, tally: Tally, nearness: Nearness
    ) -> None:
        self._pacer = pacer
        setup = pacer.setup
        self._rates, self._senses = rates, senses
        self._solver = TickSolver(setup.kinematics.of_pose, pacer.qp, NEWTON_STEPS)
        self._modelled = setup.kinematics.of_pose
        rotation, position = setup.kinematics.tool_pose(setup.start)
        start = PlannedRow(setup.start, rotation, position, setup.start, setup.start, None)
        self._now = uncorrected(start)
        self._request = np.zeros(6)
        self._around: Surroundings | None = None
        self._tick = 0
        self._looked_at = -1
        self.tally, self.nearness = tally, nearness

    def rows(self, executed: Iterable[Executed]) -> Iterator[CorrectedRow]:
        """Rows of the blocks, corrected; they end at rest, also where the program ends in an error.

        Raises what the sensor raises, PacingError for what it must not say, and what the blocks raise.
        """
        source = iter(executed)
        while True:
            # Motions are planned with obstacles where they are then.
            self._look(self._now.row.block)
            try:
                motion = self._next(source)
            except IrlxError:
                yield from self._rest()
                raise
            if motion is None:
                yield from self._rest()
                return
            around = self._surroundings(motion)
            yield from self._made_fit(motion, around)
            self._begin(around)
            for row in motion.rows:
                yield self._moved(row, around)

    def _next(self, source: Iterator[Executed]) -> PlannedMotion | None:
        """The next motion of the program from stop to stop, None where there is none any more."""
        parts: list[Executed] = []
        for executed in source:
            if executed.rows is not None:
                self._check_frame(executed.block)
                parts.append(executed)
            if not goes_on(executed.rows, bool(parts)) and parts:
                break
        limits = next((part.rows.limits for part in parts if part.rows is not None), None)
        free = self._pacer.options.free_joints(self._now.q.size)
        return planned_motion(parts, limits or self._pacer.setup.limits, free)

    def _check_frame(self, block: Block) -> None:
        """What is corrected is where the tool is in the world: IRL440 for a block that leads it elsewhere."""
        frame = frame_of(block)
        if frame is not None:
            raise PacingError(report("IRL440", self._pacer.locate(block.origin), frame=frame.name))

    def _surroundings(self, motion: PlannedMotion) -> Surroundings:
        setup = self._pacer.setup
        if setup.kinematics.of_pose is not self._solver.kinematics:
            self._solver = TickSolver(setup.kinematics.of_pose, self._pacer.qp, NEWTON_STEPS)
        limiter = OffsetLimiter(correction_limits(motion.limits), setup.dt)
        clearance = self._pacer.clearance
        return Surroundings(self._solver, setup.weights, motion.free, limiter, self._rates, clearance)

    def _begin(self, around: Surroundings) -> None:
        """Go on under what is in force now; a new tool has a correction of its own in the same posture."""
        now, before = self._now, self._around
        self._around = around
        other_tool = around.kinematics is not self._modelled
        if other_tool:
            self._modelled = around.kinematics
            now = _with_tool(now, around)
        if before is not None and not now.as_planned:
            same = np.array_equal(around.free, before.free) and np.array_equal(around.weights, before.weights)
            # The nearest posture is another one now, perhaps far off: nothing may jump there.
            now = replace(now, bent=now.bent or other_tool or not same)
        self._now = now

    def _moved(self, row: PlannedRow, around: Surroundings) -> CorrectedRow:
        """The row after the one emitted last, as the sensor wants it."""
        self._look(row.block)
        if self._senses.ask is not None:
            answer = self._senses.ask()
            request = read_request(answer, self._tick + 1, around.kinematics.task, self._place(row))
            self.tally.asked(request is not None)
            if request is not None:
                self._request = request
        around = self._from_now(around)
        return self._emitted(corrected_tick(self._now, row, self._request, around), around)

    def _look(self, block: Block | None) -> None:
        """Once for each tick, see where obstacles are in it."""
        setup = self._pacer.setup
        if self._senses.look is None or setup.scene.sightings is None or self._looked_at == self._tick:
            return
        self._looked_at = self._tick
        place = self._pacer.locate(block.origin) if block is not None else None
        found = read_placements(self._senses.look(), self._tick + 1, setup.scene, place)
        self.nearness.asked(len(found))
        sightings, obstacles = setup.scene.sightings, setup.scene.obstacles
        sightings.begin_tick()
        for one in found:
            own = way_of(obstacles[one.name.casefold()])
            known = sightings.pose(one.name, (self._tick + 1) * setup.dt, own)
            rotation = known.rotation if one.rotation is None else pin.exp3(one.rotation)
            sightings.place(one.name, pin.SE3(rotation, one.position))

    def _from_now(self, around: Surroundings) -> Surroundings:
        """The same from this tick on."""
        if around.clearance is None:
            return around
        return around._replace(clearance=around.clearance.beginning(self._tick * around.limiter.dt))

    def _made_fit(self, motion: PlannedMotion, around: Surroundings) -> Iterator[CorrectedRow]:
        """Rows in which the robot stands until its offset is one that the motion can begin with."""
        if self._around is None or self._now.as_planned:
            return
        if around.solver is not self._around.solver:
            yield from self._rest()
        if self._fits(motion, around):
            return
        yield from self._rest()
        first, limits = motion.rows[0], around.limits
        if not self._fits(motion, around):
            goal = retreat_goal(self._now.offset, limits, first)
            stuck = (goal != self._now.offset) & ~movable_joints(self._around)
            if np.any(stuck):
                raise PacingError(self._cannot_keep(int(np.argmax(stuck)), limits, first))
            while np.max(np.abs(self._now.offset - goal)) > AT_GOAL:
                yield self._standing(
                    lambda row, old: stepped(
                        self._now,
                        row,
                        retreat_step(self._now.offset, self._now.speed, goal, old.limiter),
                        old,
                    )
                )
            yield from self._rest()

    def _fits(self, motion: PlannedMotion, around: Surroundings) -> bool:
        now, first = self._now, motion.rows[0]
        if np.any(now.speed[~around.free]) or self._brakes_worse(around):
            return False
        bounds = around.limiter.bounds(now.offset, now.speed, first.lowest, first.highest)
        return not bounds.conflicts.size

    def _brakes_worse(self, around: Surroundings) -> bool:
        """Whether a joint is moving that could stop sooner by the limits before than by these."""
        if self._around is None:
            return False
        speed = self._now.speed
        before, after = (
            np.where(speed > 0.0, -limits.acceleration_lower, limits.acceleration_upper)
            for limits in (self._around.limits, around.limits)
        )
        return bool(np.any((after < before) & (np.abs(speed) > after * around.limiter.dt)))

    def _rest(self) -> Iterator[CorrectedRow]:
        """Rows in which the robot stands until its offset is at rest."""
        while self._around is not None and np.any(self._now.speed):
            yield self._standing(lambda row, around: braked_tick(self._now, row, around))

    def _standing(self, tick: Callable[[PlannedRow, Surroundings], Corrected]) -> CorrectedRow:
        """A row more than planned: the plan stands."""
        if self._around is None:
            raise RuntimeError("nothing has moved yet")
        self._look(self._now.row.block)
        self._pacer.tick += 1
        self.tally.held()
        around = self._from_now(self._around)
        return self._emitted(tick(self._now.row.standing(), around), around)

    def _emitted(self, corrected: Corrected, around: Surroundings) -> CorrectedRow:
        self._now, self._tick = corrected, self._tick + 1
        row, block = corrected.row, corrected.row.block
        if block is None:
            raise RuntimeError("a row without a block")
        kinematics = around.kinematics
        target = corrected_pose(row.rotation, row.position, corrected.correction)
        left = kinematics.sizes(kinematics.difference(corrected.q, target)[0])
        if not (left.distance <= PATH_POSITION and left.angle <= PATH_ORIENTATION):
            raise ArithmeticError("a corrected tick lies off its pose: the inverse transform is at fault")
        missing = self._request - corrected.correction
        self.tally.ended(missing, self._tick, block.origin.line, corrected.governor, corrected.refused)
        rotation, position = kinematics.tool_pose(corrected.q)
        clearance, place = self._from_now(around).clearance, self._pacer.locate(block.origin)
        nearest = self.nearness.ended(clearance, corrected.q, self._tick, place)
        return CorrectedRow(corrected.q, rotation, position, block, corrected.correction, nearest)

    def _place(self, row: PlannedRow) -> Place:
        if row.block is None:
            raise RuntimeError("a row without a block")
        return self._pacer.locate(row.block.origin)

    def _cannot_keep(self, joint: int, limits: JointLimits, first: PlannedRow) -> Diagnostic:
        robot = self._pacer.setup.kinematics.description
        return report(
            "IRL584",
            self._place(first),
            joint=robot.axes[joint].name,
            offset=joint_value(robot, joint, float(self._now.offset[joint])),
            lower=joint_value(robot, joint, float(limits.position_lower[joint])),
            upper=joint_value(robot, joint, float(limits.position_upper[joint])),
        )


def _with_tool(now: Corrected, around: Surroundings) -> Corrected:
    """The same robot, at rest, with the tool that it has now and the correction that this one has."""
    rotation, position = around.kinematics.tool_pose(now.row.q)
    row = now.row._replace(rotation=rotation, position=position)
    if now.as_planned:
        return replace(now, row=row)
    correction = correction_between(rotation, position, around.kinematics.tool_pose(now.q))
    return replace(now, row=row, correction=around.of_task(correction), rate=np.zeros(SIZE))
