"""PTP: moves of the joints, straight from posture to posture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.blocks import JointIncrement, JointTarget, MoveBlock
from irlx.diagnostics import IrlxError, Place, report
from irlx.motion.plan_chain import lost_blend
from irlx.motion.plan_joint_chain import JointLeg, PlannedJointChain, plan_joint_chain
from irlx.pacing.clock import programmed_clock
from irlx.pacing.conditions import check_conditions
from irlx.pacing.errors import PacingError
from irlx.pacing.impossible import explain_broken_row
from irlx.pacing.motion import Motion
from irlx.pacing.options import LimitsInForce
from irlx.pacing.posed import Pose, pose_of, pose_target, posture_target
from irlx.pacing.posture_left import JOINTS_GIVEN, ON_THE_WAY, posture_left
from irlx.pacing.postures import asked_posture
from irlx.pacing.resolution import RowTicks
from irlx.pacing.row_check import broken_bound
from irlx.pacing.rows import MotionRows, handed_out, held
from irlx.pacing.situation import Situation
from irlx.pacing.snap import SAME_VALUE
from irlx.pacing.switches import check_joint_target
from irlx.pacing.tolerance import posture_within
from irlx.pacing.too_near import check_rows
from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]


def move_joints(situation: Situation, moves: Sequence[MoveBlock], in_force: LimitsInForce) -> Motion:
    """Carry out the first stop-to-stop motion of several PTPs, those first that pass their targets.

    Where the joined moves cannot be done, the first one is done alone. Raises PacingError or MotionError at
    its place.
    """
    first = _leg(situation, moves[0], in_force)
    legs = [first, *_further(situation, first, moves[0], moves[1:], in_force)]
    plan = plan_joint_chain(legs, situation.q, in_force.limits, situation.robot.joint_names, situation.dt)
    if plan.legs > 1:
        try:
            return _motion(situation, moves, plan, in_force, legs)
        except PacingError:
            why = "joined to the next one it cannot be done"
            situation.notes.add(lost_blend(legs[0].place, why, legs[1].place))
            names = situation.robot.joint_names
            plan = plan_joint_chain(legs[:1], situation.q, in_force.limits, names, situation.dt)
    return _motion(situation, moves, plan, in_force, legs)


def _further(
    situation: Situation,
    first: JointLeg,
    done: MoveBlock,
    moves: Sequence[MoveBlock],
    in_force: LimitsInForce,
) -> list[JointLeg]:
    """The legs behind the first one, that of `done`, as far as they can be told before it is done."""
    legs, before, asked = [], first, asked_after(situation, done)
    for move in moves:
        # What is to be said of a move is said when it is its turn.
        there = replace(situation, q=before.end, warnings=[], asked=asked)
        try:
            before = _leg(there, move, in_force)
        except IrlxError:
            break
        legs.append(before)
        asked = asked_after(there, move)
    return legs


def asked_after(situation: Situation, block: MoveBlock) -> Array | None:
    """The orientation (3, 3) asked for at the end of a PTP, None where a posture is."""
    pose = pose_target(block.target, situation.pose)
    if pose is None or not situation.kinematics.leaves_turns:
        return None
    if pose.orientation is None:
        return situation.pose[0]
    return np.asarray(Rotation.from_quat(pose.orientation).as_matrix())


def _leg(situation: Situation, block: MoveBlock, in_force: LimitsInForce) -> JointLeg:
    """A PTP as a motion to a posture. Raises PacingError where the joints may not go there."""
    place = situation.locate(block.origin)
    end = _end_posture(situation.in_frame(block.frame, place), block, in_force, place)
    # Degrees in a program come back as radians that may be off by the last bits: nothing moves for that.
    end = np.where(np.abs(end - situation.q) <= SAME_VALUE, situation.q, end)
    robot = situation.robot
    frozen = [number for number in situation.options.frozen if end[number - 1] != situation.q[number - 1]]
    if frozen:
        raise PacingError(report("IRL343", place, joint=robot.axes[frozen[0] - 1].name))
    check_joint_target(end, robot, in_force.limits, place)
    if block.reconfiguration is not None:
        why = JOINTS_GIVEN if isinstance(block.target, JointTarget | JointIncrement) else ON_THE_WAY
        left = np.array(block.reconfiguration.values) - end
        situation.warnings.extend(posture_left(left, why, robot, place))
    return JointLeg(end, block.law, block.blend, place)


def _motion(
    situation: Situation,
    moves: Sequence[MoveBlock],
    plan: PlannedJointChain,
    in_force: LimitsInForce,
    legs: Sequence[JointLeg],
) -> Motion:
    for note in plan.notes:
        situation.notes.add(note)
    motion, dt, place = plan.motion, situation.dt, situation.locate(moves[0].origin)
    asked = situation.asked
    for k, move in enumerate(moves[: plan.legs]):
        stands = situation.q if k == 0 else legs[k - 1].end
        asked = asked_after(replace(situation, q=stands, asked=asked), move)
    if motion.ticks == 0:
        return Motion((None,), in_force, programmed=_programmed(situation, moves[0]), asked=asked)
    count = situation.setup.resolution.rows_of(motion.ticks)
    q = motion.postures(dt, count)
    ticking = RowTicks(situation.tick + 1, dt, motion.ticks / count)
    _check_rows(situation, q, in_force.limits, ticking, place)
    check_conditions(q, situation.kinematics, place)
    check_rows(situation.clearance, q, situation.q, ticking, "MOVE PTP", place)
    s = programmed_clock(motion.law, motion.ticks, dt, count).s
    rows = replace(_rows(situation, moves[0], q, s), span=motion.ticks + 1)
    handed: list[MotionRows | None] = [rows]
    if plan.legs > 1:
        handed = handed_out(rows, moves[: plan.legs], plan.ends)
    last = plan.ends[-1] - (plan.ends[-2] if plan.legs > 1 else 0.0)
    rooms = 0.5 * plan.ends[0], 0.5 * last
    programmed = _programmed(situation, moves[0])
    return Motion(tuple(handed), in_force, rooms=rooms, programmed=programmed, asked=asked)


def _programmed(situation: Situation, block: MoveBlock) -> Pose | None:
    """The pose of a PTP WITH TOLERANCE, off which the tool may stand."""
    if block.tolerance is None:
        return None
    situation = situation.in_frame(block.frame, situation.locate(block.origin))
    target = pose_target(block.target, situation.pose)
    return None if target is None else pose_of(target, situation.pose)


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


def _check_rows(situation: Situation, q: Array, limits: JointLimits, ticking: RowTicks, place: Place) -> None:
    broken = broken_bound(situation.q, held(q), limits, ticking.dt * ticking.ticks_a_row)
    if broken is not None:
        broken = broken.counted_in_ticks(ticking.ticks_a_row)
        raise PacingError(explain_broken_row(broken, ticking.first_tick, situation.robot, place))


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
    return posture_within(block.tolerance, pose, near, situation, in_force, place)
