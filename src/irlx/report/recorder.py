"""Makes rows of a stream of what a run executes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.pacing.executed import Executed
from irlx.report.events import slowed_events
from irlx.report.segment import Keeper, Segment
from irlx.report.uninterrupted import uninterrupted
from irlx.streams.joint_stream import BlockRecord, StreamHeader

Array = NDArray[np.float64]


class Recorder:
    """Hands the rows of a run to `keepers`: from tick 0, the start posture at rest, on, block after block.

    `rows` is how many there are so far.
    """

    def __init__(
        self, header: StreamHeader, start: Array, rotation: Array, position: Array, keepers: Sequence[Keeper]
    ) -> None:
        """Begin at posture `start` (n,), the tool at `rotation` (3, 3), `position` (3,) m, in the world."""
        self.header = header
        self.rows = 0
        self._keepers = tuple(keepers)
        self._last = np.array([start, start])
        pose = _pose_rows(position[None, :], rotation[None, :, :], None)
        still = np.zeros((1, start.size), dtype=np.int8)
        self._hand_out(Segment(None, 0, start[None, :], np.zeros(1, np.int64), pose, still, header.limits))

    @property
    def duration(self) -> float:
        """Time of the last row, s."""
        return (self.rows - 1) * self.header.dt

    @property
    def last_postures(self) -> Array:
        """The last two rows of q (2, n); where there is but one, twice that."""
        return self._last

    def add(self, executed: Executed) -> None:
        """Add a block, or a further part of it, and the rows it became."""
        block, rows, header = executed.block, executed.rows, self.header
        record = BlockRecord(executed.tick, block) if executed.begins else None
        if rows is None:
            nothing, joints = np.zeros(0, np.int64), header.joints
            q, flags = np.zeros((0, joints)), np.zeros((0, joints), np.int8)
            self._hand_out(Segment(record, self.rows, q, nothing, np.zeros((0, 7)), flags, header.limits))
            return
        limits = rows.limits or header.limits
        segment = Segment(
            record,
            self.rows,
            rows.q,
            np.full(len(rows), block.id, dtype=np.int64),
            _pose_rows(rows.tool_position, rows.tool_rotation, self._quaternion),
            rows.active,
            limits,
            (float(rows.path_position_error.max()), float(rows.path_orientation_error.max())),
            rows.iterations,
            slowed_events(rows, limits, header.joint_names, header.dt),
            rows.path is not None and rows.path.planned,
            rows.nearest,
        )
        self._hand_out(segment)

    def _hand_out(self, segment: Segment) -> None:
        with uninterrupted():
            for keeper in self._keepers:
                keeper.take(segment)
            if len(segment.q):
                self.rows += len(segment.q)
                self._last = np.vstack([self._last, segment.q[-2:]])[-2:]
                self._quaternion = segment.tool[-1, 3:].copy()


def _pose_rows(position: Array, rotation: Array, before: Array | None) -> Array:
    """Rows x y z qx qy qz qw; the quaternion keeps the sign that makes it continuous from `before` on."""
    quaternion = Rotation.from_matrix(rotation).as_quat()
    first = quaternion[:1] if before is None else before[None, :]
    agreement = np.sum(np.vstack([first, quaternion[:-1]]) * quaternion, axis=1)
    signs = np.cumprod(np.where(agreement < 0.0, -1.0, 1.0))
    return np.hstack([position, quaternion * signs[:, None]])
