"""Which rows belong to which move, and whether block records and samples fit together."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from irlx.blocks import MotionLaw, MoveBlock, PauseBlock, ReconfigureBlock, WaitBlock
from irlx.streams.joint_stream import Integers
from irlx.verifier.findings.finding import FAILED, NOT_CHECKED, OK, Check
from irlx.verifier.outline import Outline
from irlx.verifier.sanity import wrong_numbers


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

    @cached_property
    def law(self) -> MotionLaw:
        """The bounds of its motion, its override being counted in."""
        return law_in_force(self.block.law)


def law_in_force(law: MotionLaw) -> MotionLaw:
    """The bounds that hold where an override scales time: rates by it, their changes by its powers."""
    o = law.override
    if o == 1.0:
        return law
    return replace(
        law,
        speed=law.speed * o,
        acc=law.acc * o**2,
        speed_ori=law.speed_ori * o,
        acc_ori=law.acc_ori * o**2,
        speed_ptp=law.speed_ptp * o,
        acc_ptp=law.acc_ptp * o**2,
        duration=None if law.duration is None else law.duration / o,
        jerk=None if law.jerk is None else law.jerk * o**3,
        override=1.0,
    )


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
        reason = wrong_numbers(block, joints)
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
