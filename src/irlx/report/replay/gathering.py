"""Gathers what a replay shows while a run goes on."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import Origin, PauseBlock, ToolBlock, WaitBlock
from irlx.pacing.nearest_rows import FAR, NearestRows
from irlx.report.message import Message, message
from irlx.report.replay.frames import MOST_FRAMES, Columns, Frames
from irlx.report.segment import Segment
from irlx.report.turns import angles_between
from irlx.robot.limits import JointLimits, alike
from irlx.streams.joint_stream import BlockRecord, StreamHeader

Array = NDArray[np.float64]
MOST_LISTED = 20_000
"""Blocks that a page lists, and messages; of more the first."""
MOST_SHOWN = 2000
"""Characters of a message, about."""
_RECENT = 4096
"""Blocks whose lines are kept: rows come right behind their blocks."""
Integers = NDArray[np.int64]


@dataclass
class Gathered:
    """What a run was like, so far.

    Its `rows`; `records` of its blocks; `limits` and the tick from which on each is in force, and `tools`,
    the blocks that set them; `waits` and the last tick of each; `pairs`, of which frames tell the nearest by
    its number: link, obstacle or other link, margin (m); `messages` of the program.
    Of the `blocks` so far, and of messages, at most `MOST_LISTED` are kept.
    """

    frames: Frames
    rows: int = 0
    blocks: int = 0
    records: list[BlockRecord] = field(default_factory=list)
    limits: list[tuple[int, JointLimits]] = field(default_factory=list)
    tools: list[tuple[int, ToolBlock]] = field(default_factory=list)
    waits: list[tuple[BlockRecord, int]] = field(default_factory=list)
    pairs: dict[tuple[str, str, float], int] = field(default_factory=dict)
    messages: list[Message] = field(default_factory=list)


class Gathering:
    """Keeps the frames of a run, at most `most` of them, and what happens in between."""

    def __init__(self, header: StreamHeader, most: int = MOST_FRAMES) -> None:
        self.found = Gathered(Frames(header.dt, most))
        self._header = header
        self._lines = {0: 0}
        """Lines of the program by the ids of its blocks, 0 for those in other files."""
        self._before: tuple[Array, Array] | None = None
        """The last row of q (1, n) and of the tool (1, 7)."""

    def take(self, segment: Segment) -> None:
        """Take the next segment."""
        found = self.found
        if segment.record is not None:
            self._take_record(segment.record)
        rows = len(segment.q)
        if not rows:
            return
        if not found.limits or not alike(found.limits[-1][1], segment.limits):
            found.limits.append((segment.first_tick, segment.limits))
        found.frames.take(self._columns(segment))
        found.rows += rows
        if found.waits and found.waits[-1][0].block.id == int(segment.block[-1]):
            found.waits[-1] = (found.waits[-1][0], segment.first_tick + rows - 1)
        self._before = segment.q[-1:].copy(), segment.tool[-1:].copy()

    def say(self, text: str, origin: Origin | None = None) -> None:
        """Take what the program writes for the terminal, at this moment, by the statement at `origin`."""
        self.hear(message(self.found.rows, text, origin, self._header.program_name))

    def hear(self, new: Message) -> None:
        """Take a message; what one statement writes at one tick, and what ends a line begun, is one."""
        messages = self.found.messages
        last = messages[-1] if messages else None
        if (
            last is not None
            and last.tick == new.tick
            and (last.line == new.line or not last.text.endswith("\n"))
        ):
            if len(last.text) < MOST_SHOWN:
                messages[-1] = last._replace(text=last.text + new.text)
        elif len(messages) < MOST_LISTED:
            messages.append(new)

    def _take_record(self, record: BlockRecord) -> None:
        block, found = record.block, self.found
        found.blocks += 1
        own = block.origin.file == self._header.program_name
        self._lines[block.id] = block.origin.line if own else 0
        if len(self._lines) > _RECENT:
            del self._lines[next(iter(self._lines))]
        if isinstance(block, ToolBlock):
            found.tools.append((found.rows, block))
        if found.blocks > MOST_LISTED:
            return
        found.records.append(record)
        if isinstance(block, WaitBlock | PauseBlock):
            found.waits.append((record, record.tick))

    def _columns(self, segment: Segment) -> Columns:
        q, tool, dt = segment.q, segment.tool, self._header.dt
        rows = len(q)
        q_before, tool_before = (q[:1], tool[:1]) if self._before is None else self._before
        q_before, tool_before = np.vstack([q_before, q[:-1]]), np.vstack([tool_before, tool[:-1]])
        room, distance, pair = self._nearest(rows, segment.nearest)
        return Columns(
            segment.first_tick + np.arange(rows, dtype=np.int64),
            self._lines_of(segment.block),
            q,
            tool,
            (q - q_before) / dt,
            np.linalg.norm(tool[:, :3] - tool_before[:, :3], axis=1) / dt,
            angles_between(tool_before[:, 3:], tool[:, 3:]) / dt,
            room,
            distance,
            pair,
            np.full(rows, segment.nearest is not None),
        )

    def _lines_of(self, block: Integers) -> Integers:
        ids, where = np.unique(block, return_inverse=True)
        return np.array([self._lines.get(number, 0) for number in ids.tolist()], dtype=np.int64)[where]

    def _nearest(self, rows: int, nearest: NearestRows | None) -> tuple[Array, Array, Integers]:
        """Room, distance, and the number of the pair that is nearest in so many rows."""
        far = np.full(rows, np.inf)
        if nearest is None:
            return far, far, np.full(rows, FAR, dtype=np.int64)
        pairs = self.found.pairs
        own = zip(nearest.pairs, nearest.margin.tolist(), strict=True)
        known = [pairs.setdefault((*names, margin), len(pairs)) for names, margin in own]
        # The last entry is what FAR points to.
        numbers = np.array([*known, FAR], dtype=np.int64)[nearest.pair]
        room = nearest.distance - np.append(nearest.margin, 0.0)[nearest.pair]
        return room, nearest.distance, numbers
