"""Executes blocks one after another on one robot: the owner of posture, tick and options."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.blocks import (
    Block,
    CyclicBlock,
    FreezeBlock,
    JointTarget,
    LimitSwitchBlock,
    MoveBlock,
    MoveKind,
    Origin,
    PoseTarget,
    Question,
)
from irlx.diagnostics import Diagnostic, Place, report
from irlx.motion.line import Line
from irlx.motion.plan_joint_line import plan_joint_line
from irlx.motion.plan_line import plan_line
from irlx.pacing.clock import programmed_clock
from irlx.pacing.demand import Demand, DemandModifier, demands
from irlx.pacing.errors import PacingError
from irlx.pacing.impossible import Surroundings, explain_broken_row, explain_halt, goal_shortfall, joint_value
from irlx.pacing.options import LimitsInForce, Options, limits_in_force
from irlx.pacing.row_check import broken_bound
from irlx.pacing.rows import MotionRows
from irlx.pacing.snap import SAME_VALUE, snapped
from irlx.pacing.switches import check_freeze, check_inside, check_joint_target, check_limit
from irlx.pacing.walk import Walk, walk
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.robot.promises import PATH_ORIENTATION, PATH_POSITION
from irlx.transform.criteria.criterion import Criterion
from irlx.transform.criteria.least_motion import LeastMotion
from irlx.transform.criteria.posture import Posture
from irlx.transform.posture_search import nearest_posture
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.step_bounds import StepLimiter
from irlx.transform.tick import TickSolver

Array = NDArray[np.float64]

POSTURE_REACHED = 1e-6
"""Difference (rad or m) of a joint at the end of a line to a posture that still counts as reached."""

FARTHEST_TARGET = 1e9
"""Coordinate (m) beyond which a target is out of reach of any robot, and of squares in float64."""


@dataclass(frozen=True)
class PacingSetup:
    """The robot as a run finds it: model, own limits, weights (n,), start posture (n,), tick in s."""

    kinematics: Kinematics
    limits: JointLimits
    weights: Array
    start: Array
    dt: float
    modifiers: Sequence[DemandModifier] = ()


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

    def answer(self, question: Question) -> tuple[float, ...]:
        """Answer to a question of the interpreter, all blocks before it executed."""
        return tuple(float(value) for value in self.q)

    def settled(self, block: Block) -> Block:
        """The block as it is executed here: bounds that mean the present posture lie exactly on it."""
        return snapped(block, self.q)

    def execute(self, block: Block) -> MotionRows | None:
        """Execute one block; returns the rows of a move (None for a switch or a move of no length).

        Raises PacingError or MotionError with the place of the block; the state stays at its start.
        """
        if isinstance(block, MoveBlock):
            return self._move(block)
        place = self._locate(block.origin)
        if isinstance(block, LimitSwitchBlock):
            self.warnings += check_limit(block, self._robot, self._setup.limits, self.q, place)
        if isinstance(block, FreezeBlock):
            check_freeze(block, self._robot, place)
        if isinstance(block, LimitSwitchBlock | FreezeBlock | CyclicBlock):
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
        if rows is None:
            return None
        self.q = rows.q[-1]
        self.tick += len(rows)
        return replace(rows, limits=in_force.limits)

    # ---- LIN

    def _line(self, block: MoveBlock, in_force: LimitsInForce) -> MotionRows | None:
        place = self._locate(block.origin)
        rotation, position = self._setup.kinematics.tool_pose(self.q)
        posture, target = self._line_target(block, in_force, place)
        plan = plan_line(block, target, rotation, position, self._setup.dt, place)
        if plan.ticks == 0:
            self._warn_of_posture_left(self.q, posture, place)
            return None
        free = self.options.free_joints(self.q.size)
        around = Surroundings(self._setup.kinematics, in_force.limits, free, in_force.asked_by)
        clock = programmed_clock(plan.law, plan.ticks, self._setup.dt)
        walked = walk(
            self._solver,
            StepLimiter(in_force.limits, self._setup.dt),
            self._criterion_of(posture, plan.path.length),
            free,
            self.q,
            demands(plan.path, clock, self.tick + 1, self._setup.modifiers),
        )
        if walked.halt is not None:
            goal = goal_shortfall(around, plan.path.end_rotation, plan.path.end_position, self.q)
            raise PacingError(explain_halt(walked.halt, around, plan.path, goal, place))
        self._check_rows(walked.q, in_force.limits, place)
        self._warn_of_posture_left(walked.q[-1], posture, place)
        return self._line_rows(block, plan.path, walked)

    def _line_target(
        self, block: MoveBlock, in_force: LimitsInForce, place: Place
    ) -> tuple[Array | None, PoseTarget]:
        """Pose at which a line ends, and the posture to end in where the target is one."""
        if isinstance(block.target, PoseTarget):
            return None, block.target
        posture = np.array(block.target.values)
        check_joint_target(posture, self._robot, in_force.limits, place)
        rotation, position = self._setup.kinematics.tool_pose(posture)
        x, y, z, w = Rotation.from_matrix(rotation).as_quat()
        return posture, PoseTarget(
            (float(position[0]), float(position[1]), float(position[2])),
            (float(x), float(y), float(z), float(w)),
        )

    def _criterion_of(self, posture: Array | None, length: float) -> Callable[[Demand], Criterion]:
        """The one posture term in force: a target posture on the way, else cyclic return, else least motion.

        Towards a target posture the reference runs from the present one with the path parameter, so
        that it is reached together with the pose.
        """
        weights, start = self._setup.weights, self.q
        if posture is not None:
            way = posture - start
            return lambda demand: Posture(weights, start + (demand.s / length) * way)
        fixed: Criterion = LeastMotion(weights)
        if self.options.cyclic_posture is not None:
            fixed = Posture(weights, self.options.cyclic_posture)
        return lambda demand: fixed

    def _warn_of_posture_left(self, q: Array, posture: Array | None, place: Place) -> None:
        if posture is None:
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

    def _line_rows(self, block: MoveBlock, path: Line, walked: Walk) -> MotionRows:
        position_error, orientation_error, tool_position, tool_rotation = self._tool(walked.q, walked.demands)
        if position_error.max() > PATH_POSITION or orientation_error.max() > PATH_ORIENTATION:
            raise ArithmeticError("a solved tick lies off the path: the inverse transform is at fault")
        return MotionRows(
            block,
            self.tick + 1,
            _held(walked.q),
            _held(tool_position),
            _held(tool_rotation),
            _held(position_error),
            _held(orientation_error),
            np.vstack([walked.active, np.zeros_like(walked.active[-1:])]),
            _held(np.array([demand.s for demand in walked.demands])),
            path.length,
            walked.iterations,
        )

    def _tool(self, q: Array, asked: Sequence[Demand]) -> tuple[Array, Array, Array, Array]:
        """Tool poses of rows and their distance (m) and angle (rad) from the demands."""
        poses = [self._setup.kinematics.tool_pose(row) for row in q]
        rotation, position = (np.array(part) for part in zip(*poses, strict=True))
        wanted_position = np.array([demand.position for demand in asked])
        wanted_rotation = np.array([demand.rotation for demand in asked])
        apart = Rotation.from_matrix(np.swapaxes(wanted_rotation, 1, 2) @ rotation)
        return np.linalg.norm(position - wanted_position, axis=1), apart.magnitude(), position, rotation

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
        if plan.ticks == 0:
            return None
        q = plan.postures(self._setup.dt)
        self._check_rows(q, in_force.limits, place)
        poses = [self._setup.kinematics.tool_pose(row) for row in q]
        rotation, position = (np.array(part) for part in zip(*poses, strict=True))
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
        rotation, _ = self._setup.kinematics.tool_pose(self.q)
        if block.target.orientation is not None:
            rotation = np.asarray(Rotation.from_quat(block.target.orientation).as_matrix())
        position = np.array(block.target.position)
        farthest = float(np.max(np.abs(position)))
        if farthest > FARTHEST_TARGET:
            raise PacingError(report("IRL522", place, distance=f"{farthest * 1000.0:.6g}", angle="0"))
        free = self.options.free_joints(self.q.size)
        drawn_to = self.options.cyclic_posture if self.options.cyclic_posture is not None else self.q
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
