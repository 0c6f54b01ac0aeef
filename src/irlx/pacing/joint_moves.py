"""PTP: moves of the joints, straight from posture to posture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import JointIncrement, JointTarget, MoveBlock
from irlx.diagnostics import Place, report
from irlx.motion.plan_joint_line import plan_joint_line
from irlx.pacing.clock import programmed_clock
from irlx.pacing.conditions import check_conditions
from irlx.pacing.errors import PacingError
from irlx.pacing.impossible import explain_broken_row
from irlx.pacing.motion import Motion
from irlx.pacing.options import LimitsInForce
from irlx.pacing.posed import pose_target, posture_target
from irlx.pacing.posture_left import JOINTS_GIVEN, ON_THE_WAY, posture_left
from irlx.pacing.postures import asked_posture, posture_of_pose
from irlx.pacing.row_check import broken_bound
from irlx.pacing.rows import MotionRows, held
from irlx.pacing.situation import Situation
from irlx.pacing.snap import SAME_VALUE
from irlx.pacing.switches import check_joint_target
from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]


def move_joints(situation: Situation, moves: Sequence[MoveBlock], in_force: LimitsInForce) -> Motion:
    """Carry out the first of several PTPs. Raises PacingError or MotionError at its place."""
    block = moves[0]
    return Motion((_moved(situation, block, in_force, situation.locate(block.origin)),), in_force)


def _moved(
    situation: Situation, block: MoveBlock, in_force: LimitsInForce, place: Place
) -> MotionRows | None:
    end = _end_posture(situation, block, in_force, place)
    # Degrees in a program come back as radians that may be off by the last bits: nothing moves for that.
    end = np.where(np.abs(end - situation.q) <= SAME_VALUE, situation.q, end)
    robot, dt = situation.robot, situation.dt
    frozen = [number for number in situation.options.frozen if end[number - 1] != situation.q[number - 1]]
    if frozen:
        raise PacingError(report("IRL343", place, joint=robot.axes[frozen[0] - 1].name))
    check_joint_target(end, robot, in_force.limits, place)
    plan = plan_joint_line(situation.q, end, block.law, in_force.limits, robot.joint_names, dt, place)
    if block.reconfiguration is not None:
        why = JOINTS_GIVEN if isinstance(block.target, JointTarget | JointIncrement) else ON_THE_WAY
        left = np.array(block.reconfiguration.values) - end
        situation.warnings.extend(posture_left(left, why, robot, place))
    if plan.ticks == 0:
        return None
    rows = situation.setup.resolution.rows_of(plan.ticks)
    q = plan.postures(dt, rows)
    _check_rows(situation, q, in_force.limits, dt * plan.ticks / rows, place)
    check_conditions(q, situation.kinematics, place)
    s = programmed_clock(plan.law, plan.ticks, dt, rows).s
    return replace(_rows(situation, block, q, s), span=plan.ticks + 1)


def _rows(situation: Situation, block: MoveBlock, q: Array, s: Array) -> MotionRows:
    rotation, position = situation.kinematics.tool_poses(q)
    nothing = np.zeros(len(q) + 1)
    flags = np.zeros((len(q) + 1, q.shape[1]), dtype=np.int8)
    return MotionRows(
        block,
        situation.tick + 1,
        held(q),
        held(position),
        held(rotation),
        nothing,
        nothing,
        flags,
        held(s),
        1.0,
        0,
    )


def _check_rows(situation: Situation, q: Array, limits: JointLimits, dt: float, place: Place) -> None:
    broken = broken_bound(situation.q, held(q), limits, dt)
    if broken is not None:
        raise PacingError(explain_broken_row(broken, situation.tick + 1, situation.robot, place))


def _end_posture(situation: Situation, block: MoveBlock, in_force: LimitsInForce, place: Place) -> Array:
    """Posture at which a PTP ends: as given, or the nearest one that reaches the pose."""
    given = posture_target(block.target, situation.q)
    if given is not None:
        return np.array(given.values)
    near = None
    if block.reconfiguration is not None:
        near = asked_posture(block.reconfiguration, situation, in_force, place)
    pose = pose_target(block.target, situation.pose)
    assert pose is not None
    return posture_of_pose(pose, near, situation, in_force, place)
