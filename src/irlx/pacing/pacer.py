"""Executes blocks one after another on one robot: the owner of posture, tick and options."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from math import hypot, inf

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.blocks import (
    AskInput,
    AskInputChange,
    AskManipulability,
    AskNearestPosture,
    AskPose,
    AskPosture,
    Block,
    CriterionBlock,
    FreezeBlock,
    JointTarget,
    LimitSwitchBlock,
    MachineQuestion,
    MoveBlock,
    MoveKind,
    Origin,
    PauseBlock,
    PoseTarget,
    ReconfigureBlock,
    WaitBlock,
)
from irlx.diagnostics import Diagnostic, Place, report
from irlx.motion.arc import Arc
from irlx.motion.plan_joint_line import plan_joint_line
from irlx.motion.plan_path import PlannedPath, plan_path
from irlx.motion.whole_ticks import ticks_of_move
from irlx.pacing.answers import answer_of_posture
from irlx.pacing.clock import programmed_clock
from irlx.pacing.conditions import broken_condition, check_can_move, check_conditions, check_targets
from irlx.pacing.demand import Demand, DemandModifier
from irlx.pacing.errors import PacingError
from irlx.pacing.impossible import (
    Surroundings,
    explain_broken_row,
    explain_failure,
    goal_shortfall,
    joint_value,
    slower_than_allowed,
)
from irlx.pacing.inputs import Inputs, answer_of_inputs
from irlx.pacing.options import LimitsInForce, Options, SwitchBlock, limits_in_force
from irlx.pacing.path_motion import Failure, PacedPath, PathMotion, pace_path
from irlx.pacing.posed import posed
from irlx.pacing.posture_left import (
    JOINTS_GIVEN,
    NO_WAY,
    ON_THE_WAY,
    POSTURE_REACHED,
    beyond_limits,
    posture_left,
    why_left,
)
from irlx.pacing.posture_term import Asked, posture_term
from irlx.pacing.reconfigure import reconfigured, settled_konf
from irlx.pacing.row_check import broken_bound
from irlx.pacing.rows import MotionRows, PathPart
from irlx.pacing.slowdown.model import Model
from irlx.pacing.snap import SAME_VALUE, snapped
from irlx.pacing.switches import check_freeze, check_inside, check_joint_target, check_limit
from irlx.pacing.waiting import waited
from irlx.promises import PATH_ORIENTATION, PATH_POSITION
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.robot.task import pose_errors
from irlx.transform.criteria.combined import Weighted
from irlx.transform.posture_search import nearest_posture
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.tick import TickSolver

Array = NDArray[np.float64]

FARTHEST_TARGET = 1e9
"""Coordinate (m) beyond which a target is out of reach of any robot, and of squares in float64."""

_TURN_RULES = 1e3
"""A path that turns by more than this many rad per m is told in angles: its way is next to nothing."""


@dataclass(frozen=True)
class PacingSetup:
    """The robot as a run finds it: model, own limits, weights (n,), start posture (n,), tick in s.

    A move may take `max_slow` times as long as programmed, and a tick; `inputs` are what the world says.
    """

    kinematics: Kinematics
    limits: JointLimits
    weights: Array
    start: Array
    dt: float
    modifiers: Sequence[DemandModifier] = ()
    max_slow: float = inf
    inputs: Inputs = field(default_factory=Inputs)


class Pacer:
    """Carries a robot through blocks. Each move runs from rest to rest and ends with a hold tick."""

    def __init__(self, setup: PacingSetup, locate: Callable[[Origin], Place]) -> None:
        self._setup = setup
        self._robot = setup.kinematics.description
        self._locate = locate
        self._qp = ProxQpSolver()
        self._solver = TickSolver(setup.kinematics, self._qp)
        self.q = setup.start
        self.tick = 0
        self.options = Options()
        self.warnings: list[Diagnostic] = []

    def answer(self, question: MachineQuestion) -> tuple[float, ...]:
        """Answer to a question of the interpreter, all blocks before it executed.

        Raises PacingError, IRL522, for the posture of a pose that none reaches.
        """
        if isinstance(question, AskPosture):
            return tuple(float(value) for value in self.q)
        if isinstance(question, AskInput | AskInputChange):
            setup = self._setup
            return answer_of_inputs(question, setup.inputs, self.tick * setup.dt, setup.dt, self._locate)
        if isinstance(question, AskPose | AskManipulability):
            return answer_of_posture(question, self._setup.kinematics)
        in_force = limits_in_force(self._setup.limits, self.options)
        target, place = PoseTarget(question.position, question.orientation), self._locate(question.origin)
        near = np.array(question.near) if isinstance(question, AskNearestPosture) else None
        return tuple(self._posture_of(target, near, in_force, place).tolist())

    def settled(self, block: Block) -> Block:
        """The block as it is executed here: bounds that mean the present posture lie exactly on it."""
        return snapped(block, self.q)

    def execute(self, block: Block) -> MotionRows | None:
        """Execute one block; returns the rows of a move (None for a switch or a move of no length).

        Raises PacingError or MotionError with the place of the block; the state stays at its start.
        """
        if isinstance(block, MoveBlock):
            return self._move(block)
        if isinstance(block, ReconfigureBlock):
            return self._reconfigure(block)
        place = self._locate(block.origin)
        if isinstance(block, WaitBlock | PauseBlock):
            return self._wait(block, place)
        if isinstance(block, LimitSwitchBlock):
            self.warnings += check_limit(block, self._robot, self._setup.limits, self.q, place)
        if isinstance(block, FreezeBlock):
            check_freeze(block, self._robot, self._setup.kinematics.rows, place)
        if isinstance(block, CriterionBlock) and block.choice is not None:
            from irlx.pacing.criteria import check_criterion

            check_criterion(block.choice, self._robot, place)
        if isinstance(block, SwitchBlock):
            self.options = self.options.after(block, self.q)
        return None

    def _move(self, block: MoveBlock) -> MotionRows | None:
        for clause in block.limits:
            place = self._locate(clause.origin)
            self.warnings += check_limit(clause, self._robot, self._setup.limits, self.q, place)
        in_force = limits_in_force(self._setup.limits, self.options, block.limits)
        # A clause may have let a joint out of the switch that holds again now.
        check_inside(self.q, self._robot, in_force.limits, self._locate(block.origin))
        rows = (
            self._joint_line(block, in_force) if block.kind is MoveKind.PTP else self._line(block, in_force)
        )
        return self._moved(rows, in_force)

    def _moved(self, rows: MotionRows | None, in_force: LimitsInForce) -> MotionRows | None:
        """The rows of a motion with its limits, the robot now standing at their end."""
        if rows is None:
            return None
        self.q = rows.q[-1]
        self.tick += len(rows)
        return replace(rows, limits=in_force.limits)

    def _wait(self, block: WaitBlock | PauseBlock, place: Place) -> MotionRows | None:
        setup = self._setup
        rows = waited(block, self.q, setup.dt, self.tick + 1, setup.kinematics, place)
        return self._moved(rows, limits_in_force(setup.limits, self.options))

    # ---- RECONFIGURATION

    def _reconfigure(self, block: ReconfigureBlock) -> MotionRows | None:
        place = self._locate(block.origin)
        in_force = limits_in_force(self._setup.limits, self.options)
        check_inside(self.q, self._robot, in_force.limits, place)
        free = self.options.free_joints(self.q.size)
        model = Model(self._setup.kinematics, in_force.limits, self._setup.weights, free)
        konf = self._konf(block.target, in_force, place)
        found = reconfigured(model, block, self.q, konf, self._setup.dt, self.tick + 1, place, self._qp)
        left = found.flow.remaining
        why = why_left(found.flow.end, left, found.held, self._robot)
        self.warnings += posture_left(left, why, self._robot, place)
        return self._moved(found.rows, in_force)

    def _konf(self, target: JointTarget, in_force: LimitsInForce, place: Place) -> Array:
        """Posture (n,) that RECONFIGURATION asks for; a warning where it lies outside the limits."""
        konf = settled_konf(np.array(target.values), self.q, in_force.limits)
        free = self.options.free_joints(self.q.size)
        self.warnings += beyond_limits(konf, in_force.limits, free, self._robot, place)
        return konf

    # ---- LIN and CIRCLE

    def _line(self, block: MoveBlock, in_force: LimitsInForce) -> MotionRows | None:
        place = self._locate(block.origin)
        rotation, position = self._setup.kinematics.tool_pose(self.q)
        posture = self._asked_posture(block, in_force, place)
        told = posed(block, self._setup.kinematics)
        check_targets(told, self._setup.kinematics, self.q, place)
        plan = plan_path(told, rotation, position, self._setup.dt, place)
        if plan.ticks == 0:
            self._warn_of_posture_left(self.q, posture, block, place)
            return None
        free = self.options.free_joints(self.q.size)
        model = Model(self._setup.kinematics, in_force.limits, self._setup.weights, free)
        via = self._posture_at_via(block, plan, in_force, place)
        asked = None if posture is None else Asked(posture, via)
        term = posture_term(model, self.q, plan.programmed, asked, self.options.cyclic_posture, self._qp)
        term = term.with_terms(self._added_terms(block, plan, in_force.limits), plan.programmed)
        dt, longest = self._setup.dt, self._setup.max_slow * plan.programmed.duration

        def ticks_of(duration: float) -> int:
            if duration > longest + dt:
                raise PacingError(slower_than_allowed(duration, plan.programmed.duration, longest, place))
            return ticks_of_move(duration, dt, place)

        motion = PathMotion(plan, self.q, term, dt, self.tick + 1, ticks_of, self._setup.modifiers)
        paced = pace_path(motion, model, self._solver)
        if isinstance(paced, Failure):
            around = Surroundings(self._setup.kinematics, in_force.limits, free, in_force.told)
            goal = goal_shortfall(around, plan.path.end_rotation, plan.path.end_position, self.q)
            raise PacingError(explain_failure(paced, around, plan, self.tick + 1, goal, place))
        self._warn_of_posture_left(paced.q[-1], posture, block, place)
        return self._line_rows(block, plan, paced)

    def _added_terms(self, block: MoveBlock, plan: PlannedPath, limits: JointLimits) -> tuple[Weighted, ...]:
        chosen = self.options.criteria_of(block.criteria)
        if not chosen:
            return ()
        from irlx.pacing.criteria import added_terms
        from irlx.transform.criteria.library import TermSetting

        kinematics, speed = self._setup.kinematics, plan.programmed.speed
        turning = self._robot.reach * speed * (1.0 if plan.path.is_pure_turn else plan.path.turn_rate)
        tool_speed = hypot(0.0 if plan.path.is_pure_turn else speed, turning)
        setting = TermSetting(kinematics, limits, self._setup.weights, self.q, tool_speed)
        return added_terms(chosen, setting, self._locate)

    def _asked_posture(self, block: MoveBlock, in_force: LimitsInForce, place: Place) -> Array | None:
        """The posture (n,) that a move is to end in: that of RECONFIGURATION, else its target if it is one.

        A CIRCLE with ANGLE does not end at its target: it is not drawn to the target's posture.
        """
        posture = None
        if isinstance(block.target, JointTarget) and (block.course is None or block.course.angle is None):
            posture = np.array(block.target.values)
            check_joint_target(posture, self._robot, in_force.limits, place)
        if block.reconfiguration is not None:
            posture = self._konf(block.reconfiguration, in_force, place)
        return posture

    def _posture_at_via(
        self, block: MoveBlock, plan: PlannedPath, in_force: LimitsInForce, place: Place
    ) -> tuple[float, Array] | None:
        """Share of the way at the via point of a CIRCLE, and the posture to be drawn to there.

        None where none is asked for, or a travel by ANGLE does not come to the via point.
        """
        asked = None if block.course is None else block.course.via_reconfiguration
        share = plan.path.share_at_via if isinstance(plan.path, Arc) else None
        return None if asked is None or share is None else (share, self._konf(asked, in_force, place))

    def _warn_of_posture_left(self, q: Array, posture: Array | None, block: MoveBlock, place: Place) -> None:
        if posture is None:
            return
        if block.reconfiguration is not None:
            why = NO_WAY if q is self.q else ON_THE_WAY
            self.warnings += posture_left(posture - q, why, self._robot, place)
            return
        left = np.abs(posture - q)
        joint = int(np.argmax(left))
        if left[joint] > POSTURE_REACHED:
            difference = joint_value(self._robot, joint, float(left[joint]))
            warned = report("IRL348", place, joint=self._robot.axes[joint].name, difference=difference)
            self.warnings.append(warned)

    def _check_rows(self, q: Array, limits: JointLimits, place: Place) -> None:
        held = np.vstack([q, q[-1:]])
        broken = broken_bound(self.q, held, limits, self._setup.dt)
        if broken is not None:
            raise PacingError(explain_broken_row(broken, self.tick + 1, self._robot, place))

    def _line_rows(self, block: MoveBlock, plan: PlannedPath, paced: PacedPath) -> MotionRows:
        position_error, orientation_error, tool_position, tool_rotation = self._tool(paced.q, paced.demands)
        if broken_condition(paced.q, self._setup.kinematics) is not None:
            raise ArithmeticError("a solved tick breaks a constraint: the inverse transform is at fault")
        if position_error.max() > PATH_POSITION or orientation_error.max() > PATH_ORIENTATION:
            raise ArithmeticError("a solved tick lies off the path: the inverse transform is at fault")
        return MotionRows(
            block,
            self.tick + 1,
            _held(paced.q),
            _held(tool_position),
            _held(tool_rotation),
            _held(position_error),
            _held(orientation_error),
            np.vstack([paced.active, np.zeros_like(paced.active[-1:])]),
            _held(np.array([demand.s for demand in paced.demands])),
            plan.path.length,
            paced.iterations,
            path=PathPart(
                paced.demands,
                paced.term,
                plan.programmed,
                plan.path.is_pure_turn or plan.path.turn_rate > _TURN_RULES,
                plan.path.turn_rate,
                paced.planned,
                paced.slowings,
                self.options.free_joints(self.q.size),
            ),
        )

    def _tool(self, q: Array, asked: Sequence[Demand]) -> tuple[Array, Array, Array, Array]:
        """Tool poses of rows and their distance (m) and angle (rad) from the demands."""
        kinematics = self._setup.kinematics
        rotation, position = kinematics.tool_poses(q)
        wanted = (
            np.array([demand.rotation for demand in asked]),
            np.array([demand.position for demand in asked]),
        )
        distance, angle = pose_errors(kinematics.task, wanted, (rotation, position))
        return distance, angle, position, rotation

    # ---- PTP

    def _joint_line(self, block: MoveBlock, in_force: LimitsInForce) -> MotionRows | None:
        place = self._locate(block.origin)
        end = self._end_posture(block, in_force, place)
        # Degrees in a program come back as radians that may be off by the last bits: nothing moves for that.
        end = np.where(np.abs(end - self.q) <= SAME_VALUE, self.q, end)
        frozen = [number for number in self.options.frozen if end[number - 1] != self.q[number - 1]]
        if frozen:
            joint = self._robot.axes[frozen[0] - 1].name
            raise PacingError(report("IRL343", place, joint=joint))
        check_joint_target(end, self._robot, in_force.limits, place)
        names = self._robot.joint_names
        plan = plan_joint_line(self.q, end, block.law, in_force.limits, names, self._setup.dt, place)
        if block.reconfiguration is not None:
            why = JOINTS_GIVEN if isinstance(block.target, JointTarget) else ON_THE_WAY
            left = np.array(block.reconfiguration.values) - end
            self.warnings += posture_left(left, why, self._robot, place)
        if plan.ticks == 0:
            return None
        q = plan.postures(self._setup.dt)
        self._check_rows(q, in_force.limits, place)
        check_conditions(q, self._setup.kinematics, place)
        rotation, position = self._setup.kinematics.tool_poses(q)
        clock = programmed_clock(plan.law, plan.ticks, self._setup.dt)
        nothing = np.zeros(plan.ticks + 1)
        return MotionRows(
            block,
            self.tick + 1,
            _held(q),
            _held(position),
            _held(rotation),
            nothing,
            nothing,
            np.zeros((plan.ticks + 1, self.q.size), dtype=np.int8),
            _held(clock.s),
            1.0,
            0,
        )

    def _end_posture(self, block: MoveBlock, in_force: LimitsInForce, place: Place) -> Array:
        """Posture at which a PTP ends: as given, or the nearest one that reaches the pose."""
        if isinstance(block.target, JointTarget):
            return np.array(block.target.values)
        konf = block.reconfiguration
        near = None if konf is None else self._konf(konf, in_force, place)
        return self._posture_of(block.target, near, in_force, place)

    def _posture_of(
        self, target: PoseTarget, near: Array | None, in_force: LimitsInForce, place: Place
    ) -> Array:
        """The posture of a pose nearest to `near` (n,), else to CYCLICSTART's, else to the present one."""
        check_can_move(target, self._setup.kinematics, self.q, place)
        rotation, _ = self._setup.kinematics.tool_pose(self.q)
        if target.orientation is not None:
            rotation = np.asarray(Rotation.from_quat(target.orientation).as_matrix())
        position = np.array(target.position)
        farthest = float(np.max(np.abs(position)))
        if farthest > FARTHEST_TARGET:
            raise PacingError(report("IRL522", place, distance=f"{farthest * 1000.0:.6g}", angle="0"))
        free = self.options.free_joints(self.q.size)
        drawn_to = self.options.cyclic_posture if self.options.cyclic_posture is not None else self.q
        if near is not None:
            drawn_to = near
        start = np.where(free, drawn_to, self.q)
        search = nearest_posture(
            self._setup.kinematics,
            self._qp,
            rotation,
            position,
            start,
            self._setup.weights,
            in_force.limits,
            free,
        )
        if search.q is None:
            distance, angle = search.nearest.distance * 1000.0, np.degrees(search.nearest.angle)
            raise PacingError(report("IRL522", place, distance=f"{distance:.6g}", angle=f"{angle:.4g}"))
        return search.q


def _held(rows: Array) -> Array:
    """Rows with the last one repeated: the hold tick of a stop."""
    return np.concatenate([rows, rows[-1:]])
