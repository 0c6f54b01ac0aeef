"""Which rows belong to which move, and whether block records and samples fit together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from irlx.blocks import (
    Block,
    FreezeBlock,
    InputBlock,
    JointRange,
    JointTarget,
    LimitSwitchBlock,
    MoveBlock,
    MoveKind,
    PauseBlock,
    PoseTarget,
    ReconfigureBlock,
    SignalBlock,
    SignalKind,
    WaitBlock,
)
from irlx.promises import UNIT_LENGTH
from irlx.streams.joint_stream import Integers
from irlx.verifier.findings.finding import FAILED, NOT_CHECKED, OK, Check
from irlx.verifier.outline import Outline


@dataclass(frozen=True)
class MoveRows:
    """Rows ``start + 1 .. last`` of one move; row `start` stands when it begins.

    A move without rows (its target was reached before) has ``last == start``. `finished` is False for
    the move in which an incomplete stream ends.
    """

    block: MoveBlock
    start: int
    last: int
    finished: bool

    @property
    def rows(self) -> Integers:
        """Indices of the rows of the move, hold rows included."""
        return np.arange(self.start + 1, self.last + 1)


def moves_of(outline: Outline) -> list[MoveRows]:
    """The moves of a stream in order; its records must fit its rows."""
    places = {identity: last for identity, _, last in outline.segments()}
    final = outline.rows - 1
    moves = []
    for record in outline.records:
        if isinstance(record.block, MoveBlock):
            last = places.get(record.block.id, record.tick)
            moves.append(MoveRows(record.block, record.tick, last, outline.complete or last != final))
    return moves


def check_blocks(outline: Outline, may_lack_blocks: bool) -> Check:
    """Every sample belongs to a recorded motion; each block begins where the one before it came to its end.

    Only a format that has no place for blocks may lack them.
    """
    if may_lack_blocks and not outline.records:
        return Check("blocks", NOT_CHECKED, detail="the stream carries no blocks")
    found = _misfit(outline)
    if found is None:
        return Check("blocks", OK)
    return Check("blocks", FAILED, detail=f"at tick {found[0]}: {found[1]}")


def _misfit(outline: Outline) -> tuple[int, str] | None:
    """Tick and words of the first place where samples and block records contradict each other."""
    joints, rows = outline.header.joints, outline.rows
    found = list(outline.segments())
    lasts = {identity: last for identity, _, last in found}
    begins: dict[int, int] = {}
    standing = lasts.get(0, 0)
    for due, record in enumerate(outline.records, 1):
        block = record.block
        reason = _wrong_numbers(block, joints)
        if reason:
            return record.tick, f"block {block.id}: {reason}"
        if block.id != due:
            return record.tick, f"block {block.id} stands where {due} is due: one is missing or added"
        moves = isinstance(block, MoveBlock | ReconfigureBlock | WaitBlock | PauseBlock)
        begins[block.id] = record.tick if moves else -1
        if record.tick != standing:
            late = f" (the samples end at {rows - 1})" if record.tick >= rows else ""
            words = f"block {block.id} was recorded at tick {record.tick}{late}"
            return record.tick, f"{words}, but the robot came to rest at {standing}"
        standing = lasts.get(block.id, standing) if moves else standing
    return _misplaced(found, begins)


def _misplaced(found: list[tuple[int, int, int]], begins: dict[int, int]) -> tuple[int, str] | None:
    """First stretch of rows that does not begin right after the record of its move."""
    seen: set[int] = set()
    for identity, first, _ in found:
        if first == 0:
            if identity != 0:
                return 0, f"the start posture belongs to block {identity}, not to 0"
        elif begins.get(identity, -1) < 0:
            return first, f"no recorded move has the id {identity}"
        elif identity in seen:
            return first, f"block {identity} comes back after another one"
        elif begins[identity] + 1 != first:
            return first, f"block {identity} was recorded at tick {begins[identity]} and begins at {first}"
        seen.add(identity)
    return None


def _wrong_numbers(block: Block, joints: int) -> str:
    """Why the numbers in a block do not fit a robot of n joints, or ''."""
    ranges: list[JointRange] = []
    if isinstance(block, MoveBlock):
        ranges = [clause.range for clause in block.limits]
        reason = _wrong_targets(block, joints)
        if reason:
            return reason
    for posture in _postures_beside(block):
        if len(posture.values) != joints:
            return f"its posture has {len(posture.values)} values for {joints} joints"
    if isinstance(block, LimitSwitchBlock) and block.range is not None:
        ranges = [block.range]
    if any(len(bounds.lower) != joints or len(bounds.upper) != joints for bounds in ranges):
        return f"its limits are not those of {joints} joints"
    if isinstance(block, WaitBlock | PauseBlock) and not 0.0 <= block.duration < np.inf:
        return f"it waits {block.duration} s"
    if isinstance(block, SignalBlock | InputBlock) and not _fits(block.port.kind, block.value):
        return f"its {block.port.name} is {block.value}, which is no {block.port.kind.value}"
    if isinstance(block, FreezeBlock) and not all(1 <= joint <= joints for joint in block.joints):
        return f"it freezes a joint outside 1..{joints}"
    return ""


def _fits(kind: SignalKind, value: float) -> bool:
    if kind is SignalKind.BOOL:
        return value in (0.0, 1.0)
    return abs(value) < np.inf and (kind is SignalKind.REAL or value == round(value))


def _wrong_targets(block: MoveBlock, joints: int) -> str:
    """Why target and course of a move do not fit a robot of n joints or its kind, or ''."""
    course = block.course
    if (course is not None) is not (block.kind is MoveKind.CIRCLE):
        return f"a {block.kind.value} {'needs a' if course is None else 'has no'} course"
    if course is not None and course.angle is not None and not 0.0 < abs(course.angle) < np.inf:
        return f"it cannot turn by {course.angle} rad"
    if course is not None and course.via_reconfiguration is not None and block.reconfiguration is None:
        return "it has a posture for its via point and none for its end"
    for target in (block.target,) if course is None else (course.via, block.target):
        if isinstance(target, JointTarget) and len(target.values) != joints:
            return f"its target has {len(target.values)} values for {joints} joints"
        if isinstance(target, PoseTarget) and target.orientation is not None:
            length = float(np.linalg.norm(target.orientation))
            if not abs(length - 1.0) <= UNIT_LENGTH:
                return f"its orientation is a quaternion of length {length:.6g}"
    return ""


def _postures_beside(block: Block) -> list[JointTarget]:
    """Postures of a block other than the targets of a move."""
    if isinstance(block, ReconfigureBlock):
        return [block.target]
    if not isinstance(block, MoveBlock):
        return []
    via = None if block.course is None else block.course.via_reconfiguration
    return [posture for posture in (via, block.reconfiguration) if posture is not None]
