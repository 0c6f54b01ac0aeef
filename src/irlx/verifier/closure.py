"""Cyclic closure: back at the pose where the cyclic option was switched on, the posture is the same."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import (
    Block,
    CyclicBlock,
    FreezeBlock,
    JointTarget,
    MoveBlock,
    PoseTarget,
    ReconfigureBlock,
)
from irlx.promises import CLOSURE, RETURN, TOUCH
from irlx.verifier.evidence import Evidence, Pose
from irlx.verifier.moves import MoveRows
from irlx.verifier.report import Check
from irlx.verifier.rotations import angle_between
from irlx.verifier.rows import Rows, Stretch
from irlx.verifier.way import course_of

_LED_AWAY = (
    "a limit was active, or a RECONFIGURATION, a frozen joint or joint values led away from the posture"
)


@dataclass(frozen=True)
class _Return:
    """A move that may come back to the pose of CYCLICSTART, whose row is `start`."""

    move: MoveRows
    start: int
    led_away: bool


class ClosureChecks:
    """Posture difference at every return to the pose of CYCLICSTART, by moves to a pose.

    A return whose end was governed by a limit is reported, not judged; so is one after what leads away
    from the posture, which comes back no faster than the joints can: a RECONFIGURATION, which may even have
    led to another branch of postures, frozen joints, a move to joint values.
    """

    def __init__(self, evidence: Evidence) -> None:
        self._evidence = evidence
        self._tally = evidence.tally("cyclic closure", "rad|m")
        self._returns = _possible_returns(evidence)
        self._starts = {found.start for found in self._returns.values()}
        self._poses: dict[int, Pose] = {}
        self._at_start: Pose | None = None
        self._count, self._judged = 0, 0
        self._active_last, self._moved_before = False, False

    def take(self, rows: Rows) -> None:
        """Add a portion."""
        for start in sorted(self._starts - self._poses.keys()):
            place = rows.place(start)
            if place is not None:
                self._poses[start] = rows.positions[place].copy(), rows.rotations[place].copy()
        for stretch in rows.stretches:
            found = self._returns.get(stretch.block)
            if found is None:
                continue
            self._watch_limits(rows, stretch)
            if stretch.begins or self._at_start is None:
                before = stretch.before.start
                self._at_start = rows.positions[before].copy(), rows.rotations[before].copy()
            if stretch.ends:
                self._end(int(stretch.rows[-1]), found, self._at_start)

    def _watch_limits(self, rows: Rows, stretch: Stretch) -> None:
        """Keep whether a limit is reached in the last row that moves, or in the one after."""
        if stretch.begins:
            self._active_last, self._moved_before = False, False
        moved = (rows.postures[stretch.after] != rows.postures[stretch.before]).any(axis=1)
        if not moved.any():
            if self._moved_before:
                self._active_last = self._active_last or bool(self._active(rows, stretch, 0, 1).any())
            self._moved_before = False
            return
        row = int(np.flatnonzero(moved)[-1])
        self._active_last = bool(self._active(rows, stretch, row, row + 2).any())
        self._moved_before = row == len(moved) - 1

    def _active(self, rows: Rows, stretch: Stretch, start: int, stop: int) -> NDArray[np.bool_]:
        part = slice(stretch.part.start + start, min(stretch.part.start + stop, stretch.part.stop))
        first, count = rows.first + part.start, part.stop - part.start
        active = np.zeros(count, dtype=np.bool_)
        for kind, values in (("position", rows.q), ("speed", rows.qd), ("acceleration", rows.qdd)):
            lower, upper = self._evidence.limits.bounds(kind, first, count)
            here = values[part]
            reach = TOUCH * np.maximum(1.0, np.abs(here))
            active |= ((here >= upper - reach) | (here <= lower + reach)).any(axis=1)
        return active

    def _end(self, row: int, found: _Return, before: Pose) -> None:
        """Judge the end of a move that stood at the pose `before`, if its goal is that of CYCLICSTART."""
        evidence = self._evidence
        goal = course_of(evidence, found.move, before).goal
        if goal is None or not _same_pose(goal, self._poses[found.start]):
            return
        difference = np.abs(evidence.posture(row) - evidence.posture(found.start))[None]
        judged = not (found.led_away or self._active_last)
        self._count += 1
        self._judged += judged
        self._tally.add(np.array([row]), difference, CLOSURE, judged & ~(difference <= CLOSURE))

    def checks(self) -> list[Check]:
        """Cyclic closure."""
        if self._judged < self._count:
            self._tally.detail = (
                f"{self._count - self._judged} of {self._count} returns not judged: {_LED_AWAY}"
            )
        return [self._tally.check()]


def _possible_returns(evidence: Evidence) -> dict[int, _Return]:
    """Finished moves to a pose under the cyclic option, by id, but for those WITH RECONFIGURATION: the
    option is off for them."""
    moves = {move.block.id: move for move in evidence.moves}
    found: dict[int, _Return] = {}
    start: int | None = None
    led_away = False
    for record in evidence.outline.records:
        block = record.block
        if isinstance(block, CyclicBlock):
            start, led_away = record.tick if block.active else None, False
        led_away = led_away or _leads_away(block)
        if start is None or _reconfigures(block) or not isinstance(block, MoveBlock):
            continue
        move = moves[block.id]
        if isinstance(block.target, PoseTarget) and move.finished and move.last > move.start:
            found[block.id] = _Return(move, start, led_away)
    return found


def _leads_away(block: Block) -> bool:
    to_joints = isinstance(block, MoveBlock) and isinstance(block.target, JointTarget)
    return to_joints or _reconfigures(block) or (isinstance(block, FreezeBlock) and bool(block.joints))


def _reconfigures(block: Block) -> bool:
    clause = block.reconfiguration if isinstance(block, MoveBlock) else None
    return clause is not None or isinstance(block, ReconfigureBlock)


def _same_pose(one: Pose, other: Pose) -> bool:
    near = float(np.linalg.norm(one[0] - other[0])) <= RETURN
    return near and float(angle_between(one[1], other[1])) <= RETURN
