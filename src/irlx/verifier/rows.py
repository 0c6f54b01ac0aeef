"""Second pass over a stream: its rows in portions, with their differences and tool poses."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from irlx.blocks import LinkFrame
from irlx.robot.description import RobotDescription
from irlx.streams.error import StreamError
from irlx.streams.joint_stream import Floats, Integers
from irlx.streams.scan import RowBatch, ScanItem, StatedRates
from irlx.verifier.frames import FramesInForce, frames_of
from irlx.verifier.geometry.forward import forward
from irlx.verifier.geometry.task_turns import TaskTurns
from irlx.verifier.outline import Outline, Scans
from irlx.verifier.tools import Pose, ToolsInForce, tools_of

PORTION = 4096
"""Rows looked at together: enough for numpy to be quick, little enough to be no matter of memory."""


class Stretch(NamedTuple):
    """Part of one block's rows in a portion.

    `rows` are indices into the stream, `part` selects them from the portion's arrays of R rows, `after` from
    those of R + 1 rows, `before` the rows before each of them. `begins` and `ends` tell whether the first and
    the last row of the block are among them.
    """

    block: int
    rows: Integers
    part: slice
    begins: bool
    ends: bool

    @property
    def after(self) -> slice:
        """The rows in arrays that begin with the row before the portion."""
        return slice(self.part.start + 1, self.part.stop + 1)

    @property
    def before(self) -> slice:
        """The row before each of the rows, in arrays that begin with the row before the portion."""
        return self.part


@dataclass(frozen=True, eq=False)
class Rows:
    """R consecutive rows, the first of which is row `first` of the stream.

    `q` (R, n) rad | m, `tool` (R, 7), `rates` as the file states them; differences `qd`, `qdd` (R, n) per s
    and s2, the robot resting before row 0. Arrays `postures` (R + 1, n), `positions` (R + 1, 3) m and
    `rotations` (R + 1, 3, 3) begin with the row before; for row 0 that is row 0 itself. Poses are those of
    the verifier's own forward kinematics, and empty where no robot is known: those of the tip in `tips`, of
    the tool in force in each row in `in_world`, and in `positions` and `rotations` as the frame sees it in
    which the poses of the row's block count, that of a moving link or the world. `turns` tells
    which turns of it count, None for all.
    """

    first: int
    postures: Floats
    qd: Floats
    qdd: Floats
    tool: Floats
    rates: StatedRates | None
    positions: Floats
    rotations: Floats
    outline: Outline
    tips: Pose
    tools: ToolsInForce
    in_world: Pose
    frames: FramesInForce
    turns: TaskTurns | None = None

    def __len__(self) -> int:
        return len(self.qd)

    @property
    def q(self) -> Floats:
        """Joint values (R, n), rad or m."""
        return self.postures[1:]

    @property
    def rows(self) -> Integers:
        """Indices (R,) into the stream."""
        return np.arange(self.first, self.first + len(self))

    def place(self, row: int) -> int | None:
        """Index of a row of the stream in the arrays of R + 1 rows, None where it is not in this portion."""
        return row - self.first + 1 if self.first <= row < self.first + len(self) else None

    def pose(self, place: int, block: int) -> Pose:
        """Pose (position (3,), rotation (3, 3)) of a block's tool at a `place` in arrays of R + 1 rows, as
        its frame sees it."""
        return self.pose_in(place, block, self.frames.of_block.get(block))

    def pose_in(self, place: int, block: int, frame: LinkFrame | None) -> Pose:
        """The same as another frame sees it, or the world."""
        here = slice(place, place + 1)
        number = np.array([self.tools.number(block)], dtype=np.int64)
        found = self.tools.placed((self.tips[0][here], self.tips[1][here]), number)
        position, rotation = self.frames.seen_from(frame, found, self.postures[here])
        return position[0].copy(), rotation[0].copy()

    def before(self, stretch: Stretch) -> Pose:
        """Poses (R', ..) of the stretch's own tool in the row before each of its rows, in its own frame."""
        positions, rotations = self.positions[stretch.before], self.rotations[stretch.before]
        if stretch.begins and (self.tools.change or self.frames.of_block):
            positions, rotations = positions.copy(), rotations.copy()
            positions[0], rotations[0] = self.pose(stretch.before.start, stretch.block)
        return positions, rotations

    @cached_property
    def attitudes(self) -> Floats:
        """Attitudes (R + 1, ..) of the tool in force; see `irlx.verifier.geometry.task_turns`."""
        if self.turns is None:
            return self.rotations
        return self.turns.attitudes(self.rotations, self.turns.frames(self.postures))

    @cached_property
    def stretches(self) -> list[Stretch]:
        """The portion's rows by the blocks they belong to, in order."""
        outline, last = self.outline, self.first + len(self) - 1
        found = []
        for number in range(
            int(np.searchsorted(outline.lasts, self.first)), int(np.searchsorted(outline.lasts, last)) + 1
        ):
            begin, end = int(outline.firsts[number]), int(outline.lasts[number])
            start, stop = max(begin, self.first), min(end, last) + 1
            part = slice(start - self.first, stop - self.first)
            block = int(outline.ids[number])
            found.append(Stretch(block, np.arange(start, stop), part, start == begin, stop == end + 1))
        return found


def rows_of(scans: Scans, outline: Outline, robot: RobotDescription | None) -> Iterator[Rows]:
    """The rows of a stream in portions; as many as its outline found, damage behind them being known."""
    dt = outline.header.dt
    done = 0
    earlier: tuple[Floats, Floats] | None = None
    poses: tuple[Floats, Floats] | None = None
    tools, frames = tools_of(outline.records), frames_of(outline.records, robot)
    block = np.zeros(1, dtype=np.int64)
    turns = None if robot is None else TaskTurns.of(robot)
    for portion in _portions(scans()):
        # A file that grows meanwhile is judged as it was.
        batch = portion.part(slice(0, outline.rows - done))
        if not len(batch.ticks):
            return
        q = batch.q
        before, slower = (q[:1], np.zeros_like(q[:1])) if earlier is None else earlier
        postures = np.concatenate([before, q])
        qd = np.diff(postures, axis=0) / dt
        qdd = np.diff(qd, axis=0, prepend=slower) / dt
        tips = np.zeros((0, 3)), np.zeros((0, 3, 3))
        blocks = np.concatenate([block, batch.block])
        if robot is not None:
            own = forward(robot, q)
            known = poses if poses is not None else (own[0][:1], own[1][:1])
            tips = np.concatenate([known[0], own[0]]), np.concatenate([known[1], own[1]])
            poses = tips[0][-1:], tips[1][-1:]
        placed = tools.placed(tips, tools.numbers(blocks)) if robot is not None else tips
        seen = frames.seen(placed, postures, blocks)
        block = blocks[-1:]
        told = batch.tool, batch.rates
        yield Rows(done, postures, qd, qdd, *told, *seen, outline, tips, tools, placed, frames, turns)
        earlier = q[-1:], qd[-1:]
        done += len(q)


def _portions(scan: Iterator[ScanItem]) -> Iterator[RowBatch]:
    """Row batches of a scan joined or cut to `PORTION` rows; blocks between them split batches in files."""
    waiting: list[RowBatch] = []
    count = 0
    try:
        for item in scan:
            if not isinstance(item, RowBatch):
                continue
            waiting.append(item)
            count += len(item.ticks)
            while count >= PORTION:
                whole = _joined(waiting)
                yield whole.part(slice(0, PORTION))
                waiting = [whole.part(slice(PORTION, None))]
                count -= PORTION
    except StreamError:
        # The outline has it: what stands before the damage is judged all the same.
        pass
    if count:
        yield _joined(waiting)


def _joined(batches: list[RowBatch]) -> RowBatch:
    if len(batches) == 1:
        return batches[0]
    ticks, q, block, tool = (np.concatenate([batch[field] for batch in batches]) for field in range(4))
    stated = [batch.rates for batch in batches if batch.rates is not None]
    if len(stated) < len(batches):
        return RowBatch(ticks, q, block, tool)
    return RowBatch(ticks, q, block, tool, StatedRates(*map(np.concatenate, zip(*stated, strict=True))))
