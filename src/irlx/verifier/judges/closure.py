"""Cyclic closure: back at the pose where the cyclic option was switched on, the posture is the same."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import (
    Block,
    CriterionBlock,
    CyclicBlock,
    FreezeBlock,
    JointIncrement,
    JointTarget,
    LinkFrame,
    MoveBlock,
    ObstacleBlock,
    PoseIncrement,
    PoseTarget,
    ReconfigureBlock,
    ToolBlock,
)
from irlx.promises import CLOSURE, RETURN, TOUCH
from irlx.streams.joint_stream import Floats
from irlx.verifier.evidence import Evidence
from irlx.verifier.findings.finding import NOT_CHECKED, Check
from irlx.verifier.geometry.task_turns import turned_off
from irlx.verifier.moves import MoveRows
from irlx.verifier.rows import Rows, Stretch
from irlx.verifier.tools import Pose
from irlx.verifier.way import course_of

_LED_AWAY = (
    "a limit was met, or a RECONFIGURATION, a frozen joint, a criterion, an obstacle, joint values, another"
    " frame or another tool led away from the posture"
)


@dataclass(frozen=True)
class _Return:
    """A move that may come back to the pose of CYCLICSTART, whose row is `start` and whose block `option`."""

    move: MoveRows
    start: int
    option: int
    led_away: bool


class ClosureChecks:
    """Posture difference at every return to the pose of CYCLICSTART, by moves to a pose.

    A return that closes is a good one. One that does not is reported, not judged, where a joint is at a limit
    at its end that kept it from its value, or met a position limit on the way; and after what leads away from
    the posture, which comes back no faster than the joints can: a RECONFIGURATION, which may even have
    led to another branch of postures, frozen joints, an added criterion, a move to joint values, or one in
    another frame, in which another part of the motion is free.
    """

    def __init__(self, evidence: Evidence) -> None:
        self._evidence = evidence
        self._tally = evidence.tally("cyclic closure", "rad|m")
        self._returns = _possible_returns(evidence)
        self._starts = {found.start for found in self._returns.values()}
        self._ids = {found.start: found.option for found in self._returns.values()}
        self._poses: dict[tuple[int, LinkFrame | None], list[Pose]] = {}
        self._stood_off: dict[tuple[int, LinkFrame | None], list[Pose]] = {}
        self._seen_from = {(found.start, found.move.block.frame) for found in self._returns.values()}
        self._moves = {move.block.id: move for move in evidence.moves if move.last > move.start}
        self._at_start: Pose | None = None
        self._count, self._judged = 0, 0
        joints = evidence.outline.header.joints
        self._active_last, self._moved_before = np.zeros(joints, dtype=np.bool_), False
        self._first_held: dict[int, int] = {}

    def take(self, rows: Rows) -> None:
        """Add a portion."""
        for start, frame in self._seen_from:
            place = rows.place(start)
            if place is not None:
                own = rows.pose_in(place, self._ids[start], frame)
                self._poses.setdefault((start, frame), []).append((own[0], self._attitude(own[1], start)))
        self._watch_positions(rows)
        for stretch in rows.stretches:
            move, found = self._moves.get(stretch.block), self._returns.get(stretch.block)
            if move is None or (found is None and move.last not in self._starts):
                continue
            if stretch.begins or self._at_start is None:
                self._at_start = rows.pose(stretch.before.start, stretch.block)
            if found is not None:
                self._watch_limits(rows, stretch)
            if stretch.ends:
                goal = self._goal(move, self._at_start)
                if move.last in self._starts and goal is not None:
                    # Where the tool was told to stand counts as where it stands.
                    told = goal[0], self._attitude(goal[1], move.last)
                    # Off it within bands, only a move that has bands as well comes back to the same posture.
                    kept = self._poses if move.block.tolerance is None else self._stood_off
                    kept.setdefault((move.last, move.block.frame), []).append(told)
                if found is not None and goal is not None:
                    self._end(int(stretch.rows[-1]), found, goal)

    def _attitude(self, rotation: Floats, row: int) -> Floats:
        """Attitude (1, ..) of a tool of a rotation (3, 3) in a row in which a block ends."""
        return self._evidence.placer.attitude(rotation, self._evidence.posture(row))

    def _goal(self, move: MoveRows, start: Pose) -> Pose | None:
        """Where a move that starts at a pose, or where the one before was to end, is told to stop."""
        demand = self._evidence.demands[move.block.id]
        if demand.passes or demand.follows:
            return None if demand.passes else demand.end.pose
        return course_of(self._evidence, move, start).goal

    def _watch_positions(self, rows: Rows) -> None:
        """Keep the first row behind each CYCLICSTART in which a joint met a position limit, which may have
        led the posture away."""
        waiting = self._starts - self._first_held.keys()
        if not waiting:
            return
        lower, upper = self._evidence.limits.bounds("position", rows.first, len(rows))
        reach = TOUCH * np.maximum(1.0, np.abs(rows.q))
        met = (((rows.q >= upper - reach) | (rows.q <= lower + reach)) & (lower < upper)).any(axis=1)
        at = rows.first + np.flatnonzero(met)
        for start in waiting:
            behind = at[at > start]
            if behind.size:
                self._first_held[start] = int(behind[0])

    def _watch_limits(self, rows: Rows, stretch: Stretch) -> None:
        """Keep which joints are at a limit in the last row that moves, or in the one after."""
        if stretch.begins:
            self._active_last, self._moved_before = np.zeros_like(self._active_last), False
        moved = (rows.postures[stretch.after] != rows.postures[stretch.before]).any(axis=1)
        if not moved.any():
            if self._moved_before:
                self._active_last = self._active_last | self._active(rows, stretch, 0, 1)
            self._moved_before = False
            return
        row = int(np.flatnonzero(moved)[-1])
        self._active_last = self._active(rows, stretch, row, row + 2)
        self._moved_before = row == len(moved) - 1

    def _active(self, rows: Rows, stretch: Stretch, start: int, stop: int) -> NDArray[np.bool_]:
        """Joints (n,) that are at a limit in one of some rows; who may not move at all is at none."""
        part = slice(stretch.part.start + start, min(stretch.part.start + stop, stretch.part.stop))
        first, count = rows.first + part.start, part.stop - part.start
        active = np.zeros(rows.q.shape[1], dtype=np.bool_)
        for kind, values in (("position", rows.q), ("speed", rows.qd), ("acceleration", rows.qdd)):
            lower, upper = self._evidence.limits.bounds(kind, first, count)
            here = values[part]
            reach = TOUCH * np.maximum(1.0, np.abs(here))
            at_limit = (here >= upper - reach) | (here <= lower + reach)
            active |= (at_limit & (lower < upper)).any(axis=0)
        return active

    def _end(self, row: int, found: _Return, goal: Pose) -> None:
        """Judge the end of a move to `goal`, if that is the pose of CYCLICSTART.

        A limit excuses the joints that it kept from their values, not others.
        """
        seen = found.start, found.move.block.frame
        banded = found.move.block.tolerance is not None
        at_start = self._poses[seen] + (self._stood_off.get(seen, []) if banded else [])
        if not any(_same_pose(goal, pose) for pose in at_start):
            return
        evidence = self._evidence
        difference = np.abs(evidence.posture(row) - evidence.posture(found.start))
        held = bool((self._active_last & (difference > CLOSURE)).any())
        held = held or self._first_held.get(found.start, row + 1) <= row
        closed = bool((difference <= CLOSURE).all())
        judged = closed or not (found.led_away or held)
        self._count += 1
        self._judged += judged
        offends = judged & ~(difference <= CLOSURE)
        self._tally.add(np.array([row]), difference[None], CLOSURE, offends[None])

    def checks(self) -> list[Check]:
        """Cyclic closure."""
        if self._judged < self._count:
            self._tally.detail = (
                f"{self._count - self._judged} of {self._count} returns not judged: {_LED_AWAY}"
            )
        found = self._tally.check()
        return [replace(found, status=NOT_CHECKED) if self._count and not self._judged else found]


def _possible_returns(evidence: Evidence) -> dict[int, _Return]:
    """Finished moves to a pose under the cyclic option, by id, but for those WITH RECONFIGURATION: the
    option is off for them."""
    moves = {move.block.id: move for move in evidence.moves}
    found: dict[int, _Return] = {}
    start: int | None = None
    option, led_away = 0, False
    added: frozenset[tuple[str, str]] = frozenset()
    frames: set[LinkFrame | None] = set()
    for record in evidence.outline.records:
        block = record.block
        if isinstance(block, CyclicBlock):
            start, led_away = record.tick if block.active else None, False
            option, frames = block.id, set()
        added = _added_after(added, block)
        if isinstance(block, MoveBlock):
            frames.add(block.frame)
        led_away = led_away or bool(added) or len(frames) > 1 or _leads_away(block)
        if start is None or _reconfigures(block) or not isinstance(block, MoveBlock):
            continue
        move = moves[block.id]
        to_pose = isinstance(block.target, PoseTarget | PoseIncrement)
        if to_pose and move.finished and move.last > move.start and not evidence.demands[block.id].passes:
            found[block.id] = _Return(move, start, option, led_away)
    return found


def _added_after(added: frozenset[tuple[str, str]], block: Block) -> frozenset[tuple[str, str]]:
    """What counts beside the posture term once a block has executed: criteria, obstacles kept clear of."""
    if isinstance(block, CriterionBlock):
        key, active = ("CRITERION", block.name), block.choice is not None
    elif isinstance(block, ObstacleBlock):
        key, active = ("OBSTACLE", block.name.casefold()), block.active
    else:
        return added
    return added | {key} if active else added - {key}


def _leads_away(block: Block) -> bool:
    to_joints = isinstance(block, MoveBlock) and isinstance(block.target, JointTarget | JointIncrement)
    added = isinstance(block, MoveBlock) and bool(block.criteria)
    frozen = isinstance(block, FreezeBlock) and bool(block.joints)
    return to_joints or added or frozen or isinstance(block, ToolBlock) or _reconfigures(block)


def _reconfigures(block: Block) -> bool:
    clause = block.reconfiguration if isinstance(block, MoveBlock) else None
    return clause is not None or isinstance(block, ReconfigureBlock)


def _same_pose(one: Pose, other: Pose) -> bool:
    """Whether a pose is another one, of which the attitude (1, ..) is given."""
    near = float(np.linalg.norm(one[0] - other[0])) <= RETURN
    return near and float(turned_off(other[1], one[1])[0]) <= RETURN
