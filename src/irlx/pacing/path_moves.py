"""Moves along a path: one motion from stop to stop, its rows handed out to the moves that it joins."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import MoveBlock, PathCourse
from irlx.diagnostics import Place
from irlx.motion.errors import MotionError
from irlx.motion.plan_chain import Leg, PlannedChain, lost_blend, plan_chain
from irlx.motion.plan_circle import circle_path
from irlx.motion.whole_ticks import ticks_of_move
from irlx.pacing.conditions import broken_condition, check_implied, check_targets
from irlx.pacing.drawn_to import check_postures, postures_asked, term_of, warn_of_posture_left
from irlx.pacing.errors import PacingError
from irlx.pacing.impossible import Surroundings, explain_failure, goal_shortfall, slower_than_allowed
from irlx.pacing.left_out import AskedPose, asked_poses, check_on_path, check_points, check_standing
from irlx.pacing.motion import Motion
from irlx.pacing.nearest_rows import NearestRows, nearest_of
from irlx.pacing.options import LimitsInForce
from irlx.pacing.path_motion import Failure, PacedPath, PathMotion, pace_path
from irlx.pacing.posed import Pose, end_pose, posed
from irlx.pacing.posture_term import PostureTerm
from irlx.pacing.rows import MotionRows, PathPart, handed_out, held
from irlx.pacing.situation import Situation
from irlx.pacing.tolerance import Widened, narrowed, start_of, widened
from irlx.promises import PATH_ORIENTATION, PATH_POSITION
from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]

_TURN_RULES = 1e3
"""A path that turns by more than this many rad per m is told in angles: its way is next to nothing."""


def move_along_path(situation: Situation, moves: Sequence[MoveBlock], in_force: LimitsInForce) -> Motion:
    """Carry out the first stop-to-stop motion of moves along paths, those first that pass their targets.

    All go in the frame of the first one. Where the joined moves cannot be done, that one is done alone.
    Raises PacingError or MotionError at its place.
    """
    situation = situation.in_frame(moves[0].frame, situation.locate(moves[0].origin))
    check_postures(situation, moves[0], in_force)
    start = start_of(situation, moves[0].tolerance)
    legs = _legs(situation, moves, start, in_force.limits)
    plan = plan_chain(legs, *start, situation.dt)
    if len(plan.ends) > 1:
        try:
            return _motion(situation, moves, legs, plan, in_force)
        except (MotionError, PacingError):
            why = "joined to the next one it cannot be done"
            situation.notes.add(lost_blend(legs[0].place, why, legs[1].place))
            plan = plan_chain(legs[:1], *start, situation.dt)
    return _motion(situation, moves, legs, plan, in_force)


def _legs(situation: Situation, moves: Sequence[MoveBlock], start: Pose, limits: JointLimits) -> list[Leg]:
    """Moves as motions of the tool: the first from `start`, others from where the one before was to end."""
    legs = []
    for move in moves:
        told = posed(move, situation.kinematics, start, situation.q)
        check_targets(told, situation.kinematics, situation.q, situation.locate(move.origin))
        legs.append(Leg(told, situation.locate(move.origin)))
        start = end_of_move(told, start, legs[-1].place)
        if told.path is not None and told.id not in situation.looked_at:
            situation.looked_at.add(told.id)
            check_points(asked_poses(told, start, legs[-1].place), situation, limits)
    return legs


def end_of_move(move: MoveBlock, start: Pose, place: Place) -> Pose:
    """Where a move ends that starts at a pose: a CIRCLE with ANGLE elsewhere than at its target."""
    if move.arc is None or move.arc.angle is None:
        return end_pose(move, start)
    arc = circle_path(move, *start, place)
    return arc.end_rotation, arc.end_position


def _motion(
    situation: Situation,
    moves: Sequence[MoveBlock],
    legs: Sequence[Leg],
    plan: PlannedChain,
    in_force: LimitsInForce,
) -> Motion:
    block, place = moves[0], legs[0].place
    for note in plan.notes:
        situation.notes.add(note)
    rest = _rest(moves[plan.legs], plan) if plan.points else None
    drawn = postures_asked(situation, block, plan, in_force, place)
    start = start_of(situation, block.tolerance)
    way = start, (plan.path.end_rotation, plan.path.end_position)
    found = widened(situation, in_force, drawn, block.tolerance, way)
    asked = _asked(legs, plan, start)
    if plan.ticks == 0:
        check_standing(asked, found.situation)
        warn_of_posture_left(situation, drawn, situation.q, block, place)
        programmed = _programmed(block, plan)
        return Motion((None,), in_force, rest, programmed=programmed, asked=plan.path.end_rotation)
    rows = _paced(found, block, plan, place, asked)
    warn_of_posture_left(situation, drawn, rows.q[-1], block, place)
    touched = len(plan.ends)
    handed: list[MotionRows | None] = [rows]
    if touched > 1:
        handed = handed_out(rows, moves[:touched], plan.ends)
    programmed = _programmed(block, plan)
    return Motion(tuple(handed), in_force, rest, plan.rooms, programmed, plan.path.end_rotation)


def _programmed(block: MoveBlock, plan: PlannedChain) -> Pose | None:
    """Where the path of a motion ends, if the tool may stand off it."""
    return None if block.tolerance is None else (plan.path.end_rotation, plan.path.end_position)


def _asked(legs: Sequence[Leg], plan: PlannedChain, start: Pose) -> list[AskedPose]:
    """The poses that a motion from a pose of the tool is led to."""
    found = list[AskedPose]()
    for leg in legs[: plan.legs]:
        start = end_of_move(leg.block, start, leg.place)
        found += asked_poses(leg.block, start, leg.place)
    if plan.points:
        leg = legs[plan.legs]
        found += asked_poses(leg.block, start, leg.place, plan.points)
    return found


def _paced(
    found: Widened, block: MoveBlock, plan: PlannedChain, place: Place, asked: Sequence[AskedPose]
) -> MotionRows:
    """Rows of the motion of a plan, which is led to the poses `asked`."""
    situation, in_force = found.situation, found.in_force
    model = situation.model(in_force)
    term = term_of(situation, block, plan, model, found.asked, in_force.limits)
    paced = pace_path(_path_motion(situation, plan, term, place), model, situation.solver)
    if isinstance(paced, Failure):
        told, clear = in_force.told, situation.clearance
        limits, start = in_force.limits, situation.q
        around = Surroundings(
            situation.kinematics, limits, situation.free, told, clear, start, situation.freed
        )
        goal = goal_shortfall(
            around, plan.path.end_rotation, plan.path.end_position, situation.q, bool(asked)
        )
        raise PacingError(explain_failure(paced, around, plan, situation.tick + 1, goal, place))
    check_on_path(asked, paced.q, paced.demands, (situation.kinematics, in_force.limits, situation.free))
    check_implied(paced.q, situation.kinematics, place)
    return narrowed(_rows(situation, block, plan, paced), found.freed)


def _rest(block: MoveBlock, plan: PlannedChain) -> MoveBlock:
    """What is left of a move along a PATH where the motion stops inside it."""
    course = block.path
    if course is None:
        raise TypeError("a motion stops inside a move only along a PATH")
    left = PathCourse(course.points[plan.points :], course.reconfigurations[plan.points :])
    law = replace(block.law, duration=plan.time_left)
    return replace(block, law=law, course=left if left.points else None)


def _path_motion(situation: Situation, plan: PlannedChain, term: PostureTerm, place: Place) -> PathMotion:
    dt, setup = situation.dt, situation.setup
    longest = setup.max_slow * plan.programmed.duration

    def ticks_of(duration: float) -> int:
        if duration > longest + dt:
            raise PacingError(slower_than_allowed(duration, plan.programmed.duration, longest, place))
        return ticks_of_move(duration, dt, place)

    first, changes, fine = situation.tick + 1, setup.modifiers, setup.resolution
    return PathMotion(plan, situation.q, term, dt, first, ticks_of, changes, fine, setup.watch)


def _rows(situation: Situation, block: MoveBlock, plan: PlannedChain, paced: PacedPath) -> MotionRows:
    position_error, orientation_error, tool_position, tool_rotation = _tool(situation, paced)
    if broken_condition(paced.q, situation.kinematics) is not None:
        raise ArithmeticError("a solved tick breaks a constraint: the inverse transform is at fault")
    if not (position_error.max() <= PATH_POSITION and orientation_error.max() <= PATH_ORIENTATION):
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
        held(paced.demands.s),
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
            clearance=situation.clearance,
            first_tick=situation.tick + 1,
        ),
        span=paced.demands[-1].tick + 1 - situation.tick,
        nearest=_nearest(situation, paced),
    )


def _nearest(situation: Situation, paced: PacedPath) -> NearestRows | None:
    """What comes nearest in the rows and the hold row, where the motion has looked."""
    clearance = situation.clearance
    if clearance is None or paced.closest is None:
        return None
    hold = clearance.closest(paced.q[-1], (len(paced.q) + 1) * situation.dt)
    return nearest_of(clearance, [*paced.closest, hold])


def _tool(situation: Situation, paced: PacedPath) -> tuple[Array, Array, Array, Array]:
    """Distance (m) and angle (rad) of rows from the demands, and their tool poses in the world.

    A dry run, whose rows nobody gets, takes the demands for them.
    """
    kinematics = situation.kinematics
    in_world = kinematics.world is kinematics
    asked = paced.demands.rotation, paced.demands.position
    if situation.setup.resolution.is_coarse:
        nothing = np.zeros(len(paced.q))
        rotation, position = asked if in_world else kinematics.world.tool_poses(paced.q)
        return nothing, nothing, position, rotation
    rotation, position = kinematics.tool_poses(paced.q)
    distance, angle = kinematics.errors(paced.q, asked, (rotation, position))
    if not in_world:
        rotation, position = kinematics.world.tool_poses(paced.q)
    return distance, angle, position, rotation
