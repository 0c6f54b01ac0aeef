"""Checks of what the moves do: straight and round paths, goals reached, the recorded tool pose."""

from __future__ import annotations

import numpy as np

from irlx.blocks import JointTarget, MoveKind
from irlx.promises import PATH_ORIENTATION, PATH_POSITION
from irlx.streams.joint_stream import Floats
from irlx.verifier.arcs import arc_deviation
from irlx.verifier.evidence import Evidence
from irlx.verifier.moves import MoveRows
from irlx.verifier.paths import PathDeviation, joint_line_deviation, line_deviation
from irlx.verifier.reconfigurations import add_reconfigurations
from irlx.verifier.report import Check
from irlx.verifier.rotations import angle_between, from_quaternion
from irlx.verifier.tally import Tally

JOINT_STRAIGHTNESS = 1e-9
"""Largest deviation of a joint from the straight line of a PTP move, and from its joint target, rad or m."""

BACKWARDS = 1e-9
"""Largest step back along a path, m or rad: what rounding of the poses can pretend."""

TOOL_POSITION = 1e-9
"""Largest distance between the recorded tool position and the verifier's, m."""

TOOL_ORIENTATION = 1e-9
"""Largest angle between the recorded tool orientation and the verifier's, rad."""

_OTHER_FRAME = "targets in other frames than R_BASE cannot be placed"


def check_joint_moves(evidence: Evidence) -> list[Check]:
    """PTP moves: straight in joint space, never backwards, joint targets reached."""
    straight = evidence.tally("PTP straight", "rad|m")
    progress = evidence.tally("PTP progress", "rad|m")
    goal = evidence.tally("joint goal", "rad|m")
    for move in evidence.moves:
        if move.block.kind is not MoveKind.PTP:
            continue
        q = evidence.stream.q[move.start : move.last + 1]
        if move.last > move.start:
            off, along = joint_line_deviation(q)
            straight.add(move.rows, off[1:], JOINT_STRAIGHTNESS)
            progress.add(move.rows, along[:-1] - along[1:], BACKWARDS)
        if isinstance(move.block.target, JointTarget) and move.finished:
            miss = np.abs(q[-1:] - np.array(move.block.target.values))
            goal.add(np.array([move.last]), miss, JOINT_STRAIGHTNESS)
    return [straight.check(), progress.check(), goal.check()]


def check_goals(evidence: Evidence) -> list[Check]:
    """The pose at the end of every move is that of its target."""
    position, orientation = evidence.tally("goal position", "m"), evidence.tally("goal orientation", "rad")
    skipped = 0
    for move in evidence.moves:
        if not move.finished:
            continue
        goal = evidence.goal(move)
        if goal is None:
            skipped += 1
            continue
        reached, row = evidence.pose(move.last), np.array([move.last])
        position.add(row, np.linalg.norm((reached[0] - goal[0])[None], axis=1), PATH_POSITION)
        orientation.add(row, angle_between(reached[1], goal[1])[None], PATH_ORIENTATION)
    return [_with_skipped(tally, skipped) for tally in (position, orientation)]


def check_paths(evidence: Evidence) -> list[Check]:
    """Every row of a LIN or CIRCLE lies on its path, and the path is never run backwards; a
    RECONFIGURATION stays on the pose it begins at."""
    tallies = (
        evidence.tally("path position", "m"),
        evidence.tally("path orientation", "rad"),
        evidence.tally("path progress", "m|rad"),
    )
    skipped = sum(not _add_path(evidence, move, tallies) for move in evidence.moves)
    add_reconfigurations(evidence, tallies[0], tallies[1])
    return [_with_skipped(tally, skipped) for tally in tallies]


def _add_path(evidence: Evidence, move: MoveRows, tallies: tuple[Tally, Tally, Tally]) -> bool:
    """Add the rows of a LIN or CIRCLE; False where its targets cannot be placed."""
    if move.block.kind is MoveKind.PTP or move.last == move.start:
        return True
    goal = evidence.goal(move)
    if goal is None:
        return False
    positions, rotations = evidence.poses
    part = slice(move.start + 1, move.last + 1)
    rows = positions[part], rotations[part]
    if move.block.course is None:
        found = line_deviation(evidence.pose(move.start), goal, *rows)
    else:
        via = evidence.target_pose(move.block.course.via, move)
        if via is None:
            return False
        found = _arc_deviation(evidence, move, (via[1], goal[1]), rows)
    tallies[0].add(move.rows, found.position, PATH_POSITION)
    tallies[1].add(move.rows, found.orientation, PATH_ORIENTATION)
    tallies[2].add(move.rows, np.concatenate(([0.0], found.along[:-1])) - found.along, BACKWARDS)
    if move.finished:
        # A full circle ends where it began: its goal does not tell whether it was run.
        missing = np.array([found.length - found.along[-1]])
        tallies[2].add(np.array([move.last]), missing, PATH_POSITION)
    return True


def _arc_deviation(
    evidence: Evidence, move: MoveRows, rotations: tuple[Floats, Floats], rows: tuple[Floats, Floats]
) -> PathDeviation:
    """Deviation of the rows of a CIRCLE, rotations at via and end; infinite where its points make none."""
    course, shape = move.block.course, evidence.arc(move)
    if shape is None or course is None:
        endless = np.full(len(rows[0]), np.inf)
        return PathDeviation(endless, endless, np.zeros(len(rows[0])), np.inf)
    law = move.block.law
    speed = min(law.speed, float(np.sqrt(law.acc / shape.flatness)))
    most_step = speed * shape.flatness * evidence.stream.header.tick_ns * 1e-9
    start = evidence.pose(move.start)[1]
    return arc_deviation(shape, course, (start, *rotations), rows, most_step)


def _with_skipped(tally: Tally, skipped: int) -> Check:
    if skipped:
        tally.detail = f"{skipped} moves not checked: {_OTHER_FRAME}"
    return tally.check(nothing=tally.detail)


def check_tool(evidence: Evidence) -> list[Check]:
    """The recorded tool pose is the one that the joint values give."""
    positions, rotations = evidence.poses
    tool = evidence.stream.tool
    rows = np.arange(len(tool))
    position, orientation = evidence.tally("tool position", "m"), evidence.tally("tool orientation", "rad")
    position.add(rows, np.linalg.norm(tool[:, :3] - positions, axis=1), TOOL_POSITION)
    orientation.add(rows, angle_between(from_quaternion(tool[:, 3:]), rotations), TOOL_ORIENTATION)
    return [position.check(), orientation.check()]
