"""Moves along a path: one motion from stop to stop, its rows handed out to the moves that it joins."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import MoveBlock
from irlx.diagnostics import Place, report
from irlx.motion.arc import Arc
from irlx.motion.plan_path import PlannedPath, plan_path
from irlx.motion.whole_ticks import ticks_of_move
from irlx.pacing.conditions import broken_condition, check_targets
from irlx.pacing.demand import Demand
from irlx.pacing.errors import PacingError
from irlx.pacing.impossible import (
    Surroundings,
    explain_failure,
    goal_shortfall,
    joint_value,
    slower_than_allowed,
)
from irlx.pacing.motion import Motion
from irlx.pacing.options import LimitsInForce
from irlx.pacing.path_motion import Failure, PacedPath, PathMotion, pace_path
from irlx.pacing.posed import posed, posture_target
from irlx.pacing.posture_left import NO_WAY, ON_THE_WAY, POSTURE_REACHED, posture_left
from irlx.pacing.posture_term import Asked, PostureTerm, posture_term
from irlx.pacing.postures import asked_posture
from irlx.pacing.rows import MotionRows, PathPart, held
from irlx.pacing.situation import Situation
from irlx.pacing.slowdown.model import Model
from irlx.pacing.switches import check_joint_target
from irlx.promises import PATH_ORIENTATION, PATH_POSITION
from irlx.robot.limits import JointLimits
from irlx.robot.task import pose_errors
from irlx.transform.criteria.combined import Weighted

Array = NDArray[np.float64]

_TURN_RULES = 1e3
"""A path that turns by more than this many rad per m is told in angles: its way is next to nothing."""


def move_along_path(situation: Situation, moves: Sequence[MoveBlock], in_force: LimitsInForce) -> Motion:
    """Carry out the first of several moves along paths. Raises PacingError or MotionError at its place."""
    block = moves[0]
    return Motion((_moved(situation, block, in_force, situation.locate(block.origin)),), in_force)


def _moved(
    situation: Situation, block: MoveBlock, in_force: LimitsInForce, place: Place
) -> MotionRows | None:
    end = _end_posture(situation, block, in_force, place)
    told = posed(block, situation.kinematics, situation.pose, situation.q)
    check_targets(told, situation.kinematics, situation.q, place)
    plan = plan_path(told, *situation.pose, situation.dt, place)
    if plan.ticks == 0:
        _warn_of_posture_left(situation, end, situation.q, block, place)
        return None
    via = _via(situation, block, plan, in_force, place)
    model = situation.model(in_force)
    wanted = None if end is None else Asked(end, () if via is None else (via,))
    term = _term(situation, block, plan, model, wanted, in_force.limits)
    motion = _motion(situation, plan, term, place)
    paced = pace_path(motion, model, situation.solver)
    if isinstance(paced, Failure):
        around = Surroundings(situation.kinematics, in_force.limits, situation.free, in_force.told)
        goal = goal_shortfall(around, plan.path.end_rotation, plan.path.end_position, situation.q)
        raise PacingError(explain_failure(paced, around, plan, situation.tick + 1, goal, place))
    _warn_of_posture_left(situation, end, paced.q[-1], block, place)
    return _rows(situation, block, plan, paced)


# ---- what the move is drawn to


def _end_posture(
    situation: Situation, block: MoveBlock, in_force: LimitsInForce, place: Place
) -> Array | None:
    """The posture (n,) that a move is to end in: that of RECONFIGURATION, else its target if it is one.

    A CIRCLE with ANGLE does not end at its target: it is not drawn to the target's posture.
    """
    end = None
    given = posture_target(block.target, situation.q)
    if given is not None and (block.arc is None or block.arc.angle is None):
        end = np.array(given.values)
        check_joint_target(end, situation.robot, in_force.limits, place)
    if block.reconfiguration is not None:
        end = asked_posture(block.reconfiguration, situation, in_force, place)
    return end


def _via(
    situation: Situation, block: MoveBlock, plan: PlannedPath, in_force: LimitsInForce, place: Place
) -> tuple[float, Array] | None:
    """Share of the way at the via point of a CIRCLE, and the posture to be drawn to there.

    None where none is asked for, or a travel by ANGLE does not come to the via point.
    """
    asked = None if block.arc is None else block.arc.via_reconfiguration
    share = plan.path.share_at_via if isinstance(plan.path, Arc) else None
    if asked is None or share is None:
        return None
    return share, asked_posture(asked, situation, in_force, place)


def _term(
    situation: Situation,
    block: MoveBlock,
    plan: PlannedPath,
    model: Model,
    asked: Asked | None,
    limits: JointLimits,
) -> PostureTerm:
    cyclic = situation.options.cyclic_posture
    term = posture_term(model, situation.q, plan.programmed, asked, cyclic, situation.qp)
    return term.with_terms(_added_terms(situation, block, plan, limits), plan.programmed)


def _added_terms(
    situation: Situation, block: MoveBlock, plan: PlannedPath, limits: JointLimits
) -> tuple[Weighted, ...]:
    chosen = situation.options.criteria_of(block.criteria)
    if not chosen:
        return ()
    from irlx.pacing.criteria import added_terms
    from irlx.transform.criteria.library import TermSetting

    speed, turns = plan.programmed.speed, plan.path.is_pure_turn
    turning = situation.robot.reach * speed * (1.0 if turns else plan.path.turn_rate)
    tool_speed = hypot(0.0 if turns else speed, turning)
    weights, q = situation.setup.weights, situation.q
    return added_terms(
        chosen, TermSetting(situation.kinematics, limits, weights, q, tool_speed), situation.locate
    )


def _warn_of_posture_left(
    situation: Situation, posture: Array | None, q: Array, block: MoveBlock, place: Place
) -> None:
    """Warn of what is left to the posture asked for where a move ends in q (n,)."""
    if posture is None:
        return
    robot = situation.robot
    if block.reconfiguration is not None:
        why = NO_WAY if q is situation.q else ON_THE_WAY
        situation.warnings.extend(posture_left(posture - q, why, robot, place))
        return
    left = np.abs(posture - q)
    joint = int(np.argmax(left))
    if left[joint] > POSTURE_REACHED:
        difference = joint_value(robot, joint, float(left[joint]))
        warned = report("IRL348", place, joint=robot.axes[joint].name, difference=difference)
        situation.warnings.append(warned)


# ---- its rows


def _motion(situation: Situation, plan: PlannedPath, term: PostureTerm, place: Place) -> PathMotion:
    dt, setup = situation.dt, situation.setup
    longest = setup.max_slow * plan.programmed.duration

    def ticks_of(duration: float) -> int:
        if duration > longest + dt:
            raise PacingError(slower_than_allowed(duration, plan.programmed.duration, longest, place))
        return ticks_of_move(duration, dt, place)

    return PathMotion(plan, situation.q, term, dt, situation.tick + 1, ticks_of, setup.modifiers)


def _rows(situation: Situation, block: MoveBlock, plan: PlannedPath, paced: PacedPath) -> MotionRows:
    position_error, orientation_error, tool_position, tool_rotation = _tool(situation, paced)
    if broken_condition(paced.q, situation.kinematics) is not None:
        raise ArithmeticError("a solved tick breaks a constraint: the inverse transform is at fault")
    if position_error.max() > PATH_POSITION or orientation_error.max() > PATH_ORIENTATION:
        raise ArithmeticError("a solved tick lies off the path: the inverse transform is at fault")
    return MotionRows(
        block,
        situation.tick + 1,
        held(paced.q),
        held(tool_position),
        held(tool_rotation),
        held(position_error),
        held(orientation_error),
        np.vstack([paced.active, np.zeros_like(paced.active[-1:])]),
        held(np.array([demand.s for demand in paced.demands])),
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
            situation.free,
        ),
    )


def _tool(situation: Situation, paced: PacedPath) -> tuple[Array, Array, Array, Array]:
    """Distance (m) and angle (rad) of rows from the demands, and their tool poses."""
    kinematics = situation.kinematics
    rotation, position = kinematics.tool_poses(paced.q)
    distance, angle = pose_errors(kinematics.task, _wanted(paced.demands), (rotation, position))
    return distance, angle, position, rotation


def _wanted(asked: Sequence[Demand]) -> tuple[Array, Array]:
    rotation = np.array([demand.rotation for demand in asked])
    return rotation, np.array([demand.position for demand in asked])
