"""Cyclic closure: back at the pose where the cyclic option was switched on, the posture is the same."""

from __future__ import annotations

import numpy as np

from irlx.blocks import (
    Block,
    CyclicBlock,
    FreezeBlock,
    JointTarget,
    MoveBlock,
    PoseTarget,
    ReconfigureBlock,
)
from irlx.promises import CLOSURE, PATH_ORIENTATION, PATH_POSITION
from irlx.verifier.evidence import Evidence
from irlx.verifier.moves import MoveRows
from irlx.verifier.report import Check
from irlx.verifier.rotations import angle_between

ACTIVE = 1e-9
"""A limit that is this near, relative to max(1, |value|), may have kept the posture from closing."""


_LED_AWAY = (
    "a limit was active, or a RECONFIGURATION, a frozen joint or joint values led away from the posture"
)


def check_closure(evidence: Evidence) -> Check:
    """Posture difference at every return to the pose of CYCLICSTART, by moves to a pose.

    A return whose end was governed by a limit is reported, not judged; so is one after what leads away
    from the posture, which comes back no faster than the joints can: a RECONFIGURATION, which may even have
    led to another branch of postures, frozen joints, a move to joint values.
    """
    tally = evidence.tally("cyclic closure", "rad|m")
    returns = _returns(evidence)
    free = 0
    for move, start_row, led_away in returns:
        q = evidence.stream.q
        difference = np.abs(q[move.last] - q[start_row])[None]
        judged = not (led_away or _limit_active(evidence, move))
        free += judged
        tally.add(np.array([move.last]), difference, CLOSURE, judged & ~(difference <= CLOSURE))
    if free < len(returns):
        tally.detail = f"{len(returns) - free} of {len(returns)} returns not judged: {_LED_AWAY}"
    elif not returns:
        tally.detail = "no move under the cyclic option returned to its start pose"
    return tally.check()


def _returns(evidence: Evidence) -> list[tuple[MoveRows, int, bool]]:
    """Finished moves to a pose that end at the pose of CYCLICSTART, the row of that start, and whether
    something led away since. Moves WITH RECONFIGURATION are none: the cyclic option is off for them."""
    moves = {move.block.id: move for move in evidence.moves}
    found: list[tuple[MoveRows, int, bool]] = []
    start: int | None = None
    led_away = False
    for record in evidence.stream.records:
        if isinstance(record.block, CyclicBlock):
            start, led_away = record.tick if record.block.active else None, False
        led_away = led_away or _leads_away(record.block)
        if _reconfigures(record.block):
            continue
        if start is None or not isinstance(record.block, MoveBlock):
            continue
        move = moves[record.block.id]
        to_pose = isinstance(record.block.target, PoseTarget)
        if to_pose and move.finished and move.last > move.start and _same_pose(evidence, move.last, start):
            found.append((move, start, led_away))
    return found


def _leads_away(block: Block) -> bool:
    to_joints = isinstance(block, MoveBlock) and isinstance(block.target, JointTarget)
    return to_joints or _reconfigures(block) or (isinstance(block, FreezeBlock) and bool(block.joints))


def _reconfigures(block: Block) -> bool:
    clause = block.reconfiguration if isinstance(block, MoveBlock) else None
    return clause is not None or isinstance(block, ReconfigureBlock)


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
