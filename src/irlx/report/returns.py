"""Returns under CYCLICSTART: how near the posture came to the stored one, and what kept it from it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import (
    CriterionBlock,
    CyclicBlock,
    FreezeBlock,
    LinkFrame,
    MoveBlock,
    ObstacleBlock,
    SignalBlock,
)
from irlx.promises import CLOSURE, RETURN
from irlx.report.events import SOURCES
from irlx.report.segment import Segment
from irlx.streams.joint_stream import BlockRecord

Array = NDArray[np.float64]

Seen: TypeAlias = "Callable[[LinkFrame, Array], Array]"
"""Position (m) and quaternion, (7,), of the tool in posture q (n,) as a frame sees it."""


@dataclass(frozen=True)
class Return:
    """A move that ended at the tool pose of CYCLICSTART, in its own frame.

    `line` of the move, `tick` of its end, `since` the line of CYCLICSTART; `left` (n,) is the posture then
    less the stored one, rad or m; `held` says what stood in the way, '' where nothing did.
    """

    line: int
    tick: int
    since: int
    left: tuple[float, ...]
    held: str

    @property
    def largest(self) -> float:
        """Largest difference of a joint, rad or m."""
        return max(map(abs, self.left))

    @property
    def closed(self) -> bool:
        """Whether the posture is the stored one."""
        return self.largest <= CLOSURE

    def to_plain(self) -> dict[str, object]:
        """The return as JSON-able data."""
        return {**asdict(self), "closed": self.closed}


@dataclass
class _Standing:
    """What is in force while the records are gone through."""

    cyclic: BlockRecord | None = None
    criteria: set[str] = field(default_factory=set)
    frozen: tuple[int, ...] = ()
    obstacles: dict[str, str] = field(default_factory=dict)

    def take(self, record: BlockRecord) -> None:
        block = record.block
        if isinstance(block, CyclicBlock):
            self.cyclic = record if block.active else None
        elif isinstance(block, FreezeBlock):
            self.frozen = block.joints
        elif isinstance(block, CriterionBlock):
            change = self.criteria.discard if block.choice is None else self.criteria.add
            change(block.name)
        elif isinstance(block, ObstacleBlock):
            self.obstacles.pop(block.name.casefold(), None)
            if block.active:
                self.obstacles[block.name.casefold()] = block.name


class Returns:
    """Finds the returns of a run while it goes on.

    A move has ended when the next block begins: until then its last row is remembered. Moves in a frame that
    moves with a link come back to the pose that it has `seen` at CYCLICSTART.
    """

    def __init__(self, joint_names: Sequence[str], seen: Seen | None = None) -> None:
        self._names = tuple(joint_names)
        self._seen = seen
        self._found: list[Return] = []
        self._standing = _Standing()
        self._stored: tuple[Array, Array] | None = None
        self._last: tuple[Array, Array] | None = None
        self._move: MoveBlock | None = None
        self._end: tuple[int, Array, Array, NDArray[np.int8]] | None = None
        self._flags = np.zeros(len(self._names), dtype=np.int8)

    def take(self, segment: Segment) -> None:
        """Take the next segment."""
        if segment.record is not None and not isinstance(segment.record.block, SignalBlock):
            self._begin(segment.record)
        if not len(segment.q):
            return
        if self._move is not None and segment.block[-1] == self._move.id:
            flags = segment.active[-2] if len(segment.q) > 1 else self._flags
            tick = segment.first_tick + len(segment.q) - 1
            self._end = tick, segment.q[-1].copy(), segment.tool[-1].copy(), flags.copy()
        self._last = segment.q[-1].copy(), segment.tool[-1].copy()
        self._flags = segment.active[-1].copy()

    @property
    def found(self) -> tuple[Return, ...]:
        """All returns so far."""
        return (*self._found, *self._of_last_move())

    def _begin(self, record: BlockRecord) -> None:
        """The move before has ended, another block begins."""
        self._found += self._of_last_move()
        self._end = None
        self._standing.take(record)
        if isinstance(record.block, CyclicBlock):
            self._stored = self._last
        self._move = record.block if isinstance(record.block, MoveBlock) else None

    def _of_last_move(self) -> list[Return]:
        """The return that the last move was, if it was one."""
        cyclic, move, end = self._standing.cyclic, self._move, self._end
        if cyclic is None or move is None or end is None or self._stored is None:
            return []
        tick, q, tool, flags = end
        poses = tool, self._stored[1]
        if move.frame is not None and self._seen is not None:
            poses = self._seen(move.frame, q), self._seen(move.frame, self._stored[0])
        if not _same_pose(*poses):
            return []
        left = q - self._stored[0]
        held = _held(self._standing, move, flags, left, self._names)
        since = cyclic.block.origin.line
        return [Return(move.origin.line, tick, since, tuple(left.tolist()), held)]


def _same_pose(one: Array, other: Array) -> bool:
    alike = min(float(np.linalg.norm(one[3:] - side * other[3:])) for side in (1.0, -1.0))
    return float(np.linalg.norm(one[:3] - other[:3])) <= RETURN and 2.0 * alike <= RETURN


def _held(
    standing: _Standing, move: MoveBlock, flags: NDArray[np.int8], left: Array, joint_names: Sequence[str]
) -> str:
    if float(np.max(np.abs(left))) <= CLOSURE:
        return ""
    words = [
        f"{joint_names[int(joint)]} at its {'upper' if flags[joint] > 0 else 'lower'} "
        f"{SOURCES[abs(int(flags[joint])) - 1]} limit"
        for joint in np.flatnonzero(flags)
    ]
    if move.reconfiguration is not None:
        words.append("WITH RECONFIGURATION on this move")
    words += [f"joint {number} frozen" for number in standing.frozen]
    words += [f"CRITERION {name}" for name in sorted({*standing.criteria, *_names(move)})]
    words += [f"OBSTACLE {name}" for name in standing.obstacles.values()]
    return ", ".join(words) or "limits or options on the way"


def _names(move: MoveBlock) -> list[str]:
    return [clause.choice.name for clause in move.criteria]
