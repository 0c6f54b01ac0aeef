"""Cyclic closure: back at the pose where the cyclic option was switched on, the posture is the same."""

from __future__ import annotations

import numpy as np

from irlx.blocks import CyclicBlock, MoveBlock, PoseTarget
from irlx.robot.promises import CLOSURE, PATH_ORIENTATION, PATH_POSITION
from irlx.streams.verify.evidence import Evidence
from irlx.streams.verify.moves import MoveRows
from irlx.streams.verify.report import Check
from irlx.streams.verify.rotations import angle_between

ACTIVE = 1e-9
"""A limit that is this near, relative to max(1, |value|), may have kept the posture from closing."""


def check_closure(evidence: Evidence) -> Check:
    """Posture difference at every return to the pose of CYCLICSTART, by moves to a pose.

    A return whose end was governed by a limit is reported, not judged.
    """
    tally = evidence.tally("cyclic closure", "rad|m")
    returns = _returns(evidence)
    free = 0
    for move, start_row in returns:
        q = evidence.stream.q
        difference = np.abs(q[move.last] - q[start_row])[None]
        judged = not _limit_active(evidence, move)
        free += judged
        tally.add(np.array([move.last]), difference, CLOSURE, judged & ~(difference <= CLOSURE))
    if free < len(returns):
        tally.detail = f"{len(returns) - free} of {len(returns)} returns not judged: a limit was active"
    elif not returns:
        tally.detail = "no move under the cyclic option returned to its start pose"
    return tally.check()


def _returns(evidence: Evidence) -> list[tuple[MoveRows, int]]:
    """Finished moves to a pose that end at the pose of CYCLICSTART, with the row of that start."""
    moves = {move.block.id: move for move in evidence.moves}
    found: list[tuple[MoveRows, int]] = []
    start: int | None = None
    for record in evidence.stream.records:
        if isinstance(record.block, CyclicBlock):
            start = record.tick if record.block.active else None
        if start is None or not isinstance(record.block, MoveBlock):
            continue
        move = moves[record.block.id]
        to_pose = isinstance(record.block.target, PoseTarget)
        if to_pose and move.finished and move.last > move.start and _same_pose(evidence, move.last, start):
            found.append((move, start))
    return found


def _same_pose(evidence: Evidence, first: int, second: int) -> bool:
    one, other = evidence.pose(first), evidence.pose(second)
    near = float(np.linalg.norm(one[0] - other[0])) <= PATH_POSITION
    return near and float(angle_between(one[1], other[1])) <= PATH_ORIENTATION


def _limit_active(evidence: Evidence, move: MoveRows) -> bool:
    """Whether a limit is reached at the last row in which the move still moved, or in the one after it."""
    stream = evidence.stream
    moving = np.flatnonzero((np.diff(stream.q[move.start : move.last + 1], axis=0) != 0.0).any(axis=1))
    if not moving.size:
        return False
    row = move.start + 1 + int(moving[-1])
    part = slice(row, min(row + 2, len(stream.ticks)))
    for kind, values in (("position", stream.q), ("speed", stream.qd), ("acceleration", stream.qdd)):
        lower, upper = evidence.limits.bounds(kind, part)
        reach = ACTIVE * np.maximum(1.0, np.abs(values[part]))
        if ((values[part] >= upper - reach) | (values[part] <= lower + reach)).any():
            return True
    return False
