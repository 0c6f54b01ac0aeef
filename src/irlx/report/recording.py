"""Collects what a run executes into its joint stream, events and summary."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.blocks import Block, MoveBlock
from irlx.diagnostics import Diagnostic
from irlx.pacing.rows import MotionRows
from irlx.report.events import limit_events
from irlx.report.run import Run
from irlx.report.summary import Summary, closure, limit_uses
from irlx.robot.promises import PATH_POSITION
from irlx.streams.joint_stream import BlockRecord, JointStream, StreamHeader
from irlx.streams.sample import Sample

Array = NDArray[np.float64]


class Recording:
    """Rows of a run from tick 0, the start posture at rest."""

    def __init__(self, header: StreamHeader, start: Array) -> None:
        self._header = header
        self._q = [start[None, :]]
        self._block = [np.zeros(1, dtype=np.int64)]
        self._tool: list[Array] = []
        self._active = [np.zeros((1, start.size), dtype=np.int8)]
        self._records: list[BlockRecord] = []
        self._path_error = (0.0, 0.0)
        self._iterations = 0
        self._rows = 1
        self._sampled = 0

    @property
    def duration(self) -> float:
        """Time of the last row, s."""
        return (self._rows - 1) * self._header.dt

    def start_pose(self, rotation: Array, position: Array) -> None:
        """Tool pose of the start posture: rotation (3, 3), position (3,) m, in the world."""
        self._tool.append(_pose_rows(position[None, :], rotation[None, :, :], None))

    def add(self, block: Block, tick: int, rows: MotionRows | None) -> None:
        """Add a block that began at `tick`, and the rows it became."""
        self._records.append(BlockRecord(tick, block))
        if rows is None:
            return
        self._q.append(rows.q)
        self._block.append(np.full(len(rows), block.id, dtype=np.int64))
        self._tool.append(_pose_rows(rows.tool_position, rows.tool_rotation, self._tool[-1][-1, 3:]))
        self._active.append(rows.active)
        worst = float(rows.path_position_error.max()), float(rows.path_orientation_error.max())
        self._path_error = (max(self._path_error[0], worst[0]), max(self._path_error[1], worst[1]))
        self._iterations += rows.iterations
        self._rows += len(rows)

    def take_samples(self) -> Iterator[Sample]:
        """Samples of the rows added since the last call; only the last rows stay in memory."""
        q, block, tool = np.vstack(self._q), np.concatenate(self._block), np.vstack(self._tool)
        qd = np.vstack([np.zeros_like(q[:1]), np.diff(q, axis=0)]) / self._header.dt
        qdd = np.vstack([np.zeros_like(q[:1]), np.diff(qd, axis=0)]) / self._header.dt
        first_tick = self._rows - len(q)
        for row in range(self._sampled - first_tick, len(q)):
            tick = first_tick + row
            t = tick * self._header.tick_ns / 1e9
            yield Sample(tick, t, q[row], qd[row], qdd[row], tool[row], int(block[row]))
        self._sampled = self._rows
        # Every motion ends with a hold row: two rows carry rest over into the next differences.
        self._q, self._block, self._tool = [q[-2:]], [block[-2:]], [tool[-2:]]
        self._records.clear()

    def finish(self, complete: bool, diagnostics: tuple[Diagnostic, ...]) -> Run:
        """The run as it stands."""
        q = np.vstack(self._q)
        stream = JointStream(
            self._header,
            tuple(self._records),
            np.arange(self._rows, dtype=np.int64),
            q,
            np.concatenate(self._block),
            np.vstack(self._tool),
            complete,
        )
        events = limit_events(np.vstack(self._active), self._header.joint_names, self._header.dt)
        names = self._header.joint_names
        moves = sum(isinstance(record.block, MoveBlock) for record in self._records)
        summary = Summary(
            program=self._header.program_name,
            complete=complete,
            duration=self.duration,
            samples=self._rows,
            moves=moves,
            path_position_error=self._path_error[0],
            path_orientation_error=self._path_error[1],
            limit_use=limit_uses(q, stream.qd, stream.qdd, self._header.limits, names),
            active=events,
            closure=closure(q, stream.tool, names, PATH_POSITION),
            iterations_per_tick=self._iterations / max(self._rows - 1, 1),
        )
        return Run(stream, events, summary, diagnostics)


def _pose_rows(position: Array, rotation: Array, before: Array | None) -> Array:
    """Rows x y z qx qy qz qw; the quaternion keeps the sign that makes it continuous from `before` on."""
    quaternion = Rotation.from_matrix(rotation).as_quat()
    first = quaternion[:1] if before is None else before[None, :]
    agreement = np.sum(np.vstack([first, quaternion[:-1]]) * quaternion, axis=1)
    signs = np.cumprod(np.where(agreement < 0.0, -1.0, 1.0))
    return np.hstack([position, quaternion * signs[:, None]])
