"""Returns under CYCLICSTART: how near the posture came to the stored one, and what kept it from it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import CriterionBlock, CyclicBlock, FreezeBlock, MoveBlock, ObstacleBlock
from irlx.promises import CLOSURE, RETURN
from irlx.report.events import SOURCES
from irlx.streams.joint_stream import BlockRecord

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Return:
    """A move that ended at the tool pose of CYCLICSTART.

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


def returns(
    records: Sequence[BlockRecord],
    q: Array,
    tool: Array,
    block: NDArray[np.int64],
    active: NDArray[np.int8],
    joint_names: Sequence[str],
) -> tuple[Return, ...]:
    """Every return of a run with rows q (N, n), tool (N, 7), block ids (N,) and `active` flags (N, n)."""
    found: list[Return] = []
    standing = _Standing()
    for record in records:
        standing.take(record)
        cyclic, move = standing.cyclic, record.block
        if cyclic is None or not isinstance(move, MoveBlock):
            continue
        # Ids rise along the rows.
        last = int(np.searchsorted(block, move.id, side="right")) - 1
        if block[last] != move.id or not _same_pose(tool[last], tool[cyclic.tick]):
            continue
        left = q[last] - q[cyclic.tick]
        held = _held(standing, move, active[last - 1], left, joint_names)
        since = cyclic.block.origin.line
        found.append(Return(move.origin.line, last, since, tuple(left.tolist()), held))
    return tuple(found)


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
