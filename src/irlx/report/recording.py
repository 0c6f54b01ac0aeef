"""Collects what a run executes into its joint stream, events and summary."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.blocks import MoveBlock, ReconfigureBlock
from irlx.diagnostics import Diagnostic
from irlx.pacing.executed import Executed
from irlx.pacing.nearest_rows import NearestRows
from irlx.promises import PATH_POSITION
from irlx.report.clearances import clearances
from irlx.report.events import Slowed, limit_events, slowed_events
from irlx.report.returns import returns
from irlx.report.run import Run
from irlx.report.summary import LimitUse, Summary, closure, limit_uses
from irlx.robot.limits import JointLimits
from irlx.streams.joint_stream import BlockRecord, JointStream, StreamHeader
from irlx.streams.sample import Sample

Array = NDArray[np.float64]


class _Segment(NamedTuple):
    """Rows of one block, or of the start; added to a recording as a whole, or not at all."""

    record: BlockRecord | None
    q: Array
    block: NDArray[np.int64]
    tool: Array
    active: NDArray[np.int8]
    limits: JointLimits
    path_error: tuple[float, float] = (0.0, 0.0)
    iterations: int = 0
    slowed: tuple[Slowed, ...] = ()
    planned: bool = False
    nearest: NearestRows | None = None


class Recording:
    """Rows of a run from tick 0, the start posture at rest."""

    def __init__(self, header: StreamHeader, start: Array, rotation: Array, position: Array) -> None:
        """Begin at posture `start` (n,), the tool at `rotation` (3, 3), `position` (3,) m, in the world."""
        self._header = header
        pose = _pose_rows(position[None, :], rotation[None, :, :], None)
        still = np.zeros((1, start.size), dtype=np.int8)
        first = _Segment(None, start[None, :], np.zeros(1, dtype=np.int64), pose, still, header.limits)
        self._segments = [first]
        self._rows = 1
        self._sampled = 0
        self._dropped = 0

    @property
    def duration(self) -> float:
        """Time of the last row, s."""
        return (self._rows - 1) * self._header.dt

    @property
    def last_postures(self) -> Array:
        """The last two rows of q (2, n); where there is but one, twice that."""
        rows: list[Array] = []
        for segment in reversed(self._segments):
            rows = [*segment.q[-2:], *rows][-2:]
            if len(rows) == 2:
                break
        return np.array([rows[0], rows[-1]])

    def add(self, executed: Executed) -> None:
        """Add a block, or a further part of it, and the rows it became."""
        last, block, rows = self._segments[-1], executed.block, executed.rows
        record = BlockRecord(executed.tick, block) if executed.begins else None
        if rows is None:
            nothing = last.q[:0], last.block[:0], last.tool[:0], last.active[:0]
            self._segments.append(_Segment(record, *nothing, self._header.limits))
            return
        header, limits = self._header, rows.limits or self._header.limits
        before = next(segment.tool[-1, 3:] for segment in reversed(self._segments) if len(segment.tool))
        self._segments.append(
            _Segment(
                record,
                rows.q,
                np.full(len(rows), block.id, dtype=np.int64),
                _pose_rows(rows.tool_position, rows.tool_rotation, before),
                rows.active,
                limits,
                (float(rows.path_position_error.max()), float(rows.path_orientation_error.max())),
                rows.iterations,
                slowed_events(rows, limits, header.joint_names, header.dt),
                rows.path is not None and rows.path.planned,
                rows.nearest,
            )
        )
        self._rows += len(rows)

    def take_samples(self) -> Iterator[Sample]:
        """Samples of the rows added since the last call; only the last rows stay in memory."""
        q, block, tool = self._columns()
        qd, qdd = _rates(q, self._header.dt)
        first_tick = self._dropped
        for row in range(self._sampled - first_tick, len(q)):
            tick = first_tick + row
            t = tick * self._header.tick_ns / 1e9
            yield Sample(tick, t, q[row], qd[row], qdd[row], tool[row], int(block[row]))
        self._sampled = first_tick + len(q)
        # Every motion ends with a hold row: two rows carry rest over into the next differences.
        keep = slice(max(len(q) - 2, 0), None)
        self._dropped += keep.start
        last = self._segments[-1]
        still = np.zeros((len(q[keep]), q.shape[1]), dtype=np.int8)
        self._segments = [_Segment(None, q[keep], block[keep], tool[keep], still, last.limits)]

    def finish(self, complete: bool, diagnostics: tuple[Diagnostic, ...]) -> Run:
        """The run as it stands."""
        q, block, tool = self._columns()
        records = tuple(segment.record for segment in self._segments if segment.record is not None)
        ticks = np.arange(len(q), dtype=np.int64)
        stream = JointStream(self._header, records, ticks, q, block, tool, complete)
        names = self._header.joint_names
        active = np.concatenate([segment.active for segment in self._segments])
        events = limit_events(active, names, self._header.dt)
        slowed = tuple(event for segment in self._segments for event in segment.slowed)
        near = clearances((len(segment.q), segment.nearest) for segment in self._segments)
        iterations = sum(segment.iterations for segment in self._segments)
        summary = Summary(
            program=self._header.program_name,
            complete=complete,
            duration=self.duration,
            samples=len(q),
            moves=sum(isinstance(record.block, MoveBlock | ReconfigureBlock) for record in records),
            path_position_error=max(segment.path_error[0] for segment in self._segments),
            path_orientation_error=max(segment.path_error[1] for segment in self._segments),
            limit_use=self._limit_use(stream),
            active=events,
            slowed=slowed,
            planned=sum(segment.planned for segment in self._segments),
            closure=closure(q, tool, names, PATH_POSITION),
            iterations_per_tick=iterations / max(len(q) - 1, 1),
            returns=returns(records, q, tool, block, active, names),
            clearance=near.smallest,
        )
        return Run(stream, (*events, *slowed), summary, diagnostics, clearances=near)

    def _columns(self) -> tuple[Array, NDArray[np.int64], Array]:
        """Rows of q (N, n), block (N,) and tool (N, 7)."""
        q = np.concatenate([segment.q for segment in self._segments])
        block = np.concatenate([segment.block for segment in self._segments])
        return q, block, np.concatenate([segment.tool for segment in self._segments])

    def _limit_use(self, stream: JointStream) -> tuple[LimitUse, ...]:
        """Largest use of each kind of limit, each row judged by the limits in force at it."""
        worst: dict[str, LimitUse] = {}
        first = 0
        for segment in self._segments:
            rows = slice(first, first + len(segment.q))
            first = rows.stop
            if len(segment.q) == 0:
                continue
            for use in limit_uses(
                segment.q, stream.qd[rows], stream.qdd[rows], segment.limits, self._header.joint_names
            ):
                if use.kind not in worst or use.share > worst[use.kind].share:
                    worst[use.kind] = replace(use, tick=use.tick + rows.start)
        return tuple(worst[kind] for kind in ("position", "speed", "acceleration") if kind in worst)


def _rates(q: Array, dt: float) -> tuple[Array, Array]:
    """Backward differences of rows (N, n) and of these, per s and s2, from rest before the first."""
    qd = np.vstack([np.zeros_like(q[:1]), np.diff(q, axis=0)]) / dt
    return qd, np.vstack([np.zeros_like(q[:1]), np.diff(qd, axis=0)]) / dt


def _pose_rows(position: Array, rotation: Array, before: Array | None) -> Array:
    """Rows x y z qx qy qz qw; the quaternion keeps the sign that makes it continuous from `before` on."""
    quaternion = Rotation.from_matrix(rotation).as_quat()
    first = quaternion[:1] if before is None else before[None, :]
    agreement = np.sum(np.vstack([first, quaternion[:-1]]) * quaternion, axis=1)
    signs = np.cumprod(np.where(agreement < 0.0, -1.0, 1.0))
    return np.hstack([position, quaternion * signs[:, None]])
