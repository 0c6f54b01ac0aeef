"""ROS 2 bags: every row as messages, every motion as a trajectory, everything else as JSON."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from itertools import chain
from pathlib import Path

import numpy as np

from irlx.streams.atomic_folder import AtomicFolder
from irlx.streams.error import cannot_write
from irlx.streams.header_plain import header_to_plain, record_to_plain
from irlx.streams.joint_stream import BlockRecord, StreamHeader
from irlx.streams.rates import Rates
from irlx.streams.rosbag.definitions import definitions_of
from irlx.streams.rosbag.files import MCAP, METADATA, may_replace
from irlx.streams.rosbag.mcap_writer import McapWriter
from irlx.streams.rosbag.messages import (
    LONGEST_TIME_NS,
    MESSAGE_HEAD,
    ROWS_OF_A_CHUNK,
    SECOND,
    TOPICS,
    RowForm,
    Topic,
    message_head,
    text_message,
)
from irlx.streams.rosbag.metadata import metadata_file, metadata_text
from irlx.streams.rosbag.trajectories import Trajectories, Trajectory
from irlx.streams.row_portions import RowPortions
from irlx.streams.scan import RowBatch
from irlx.streams.writer import StreamWriter


class RosbagWriter(StreamWriter):
    """Writes one stream as a ROS 2 bag; the same stream gives the same bytes.

    Chunks have `ROWS_OF_A_CHUNK` rows, fewer before a block record, whatever the batches were. Beyond what
    `StreamWriter` raises: IRL708 for times of 2^31 s and more, and for velocities that are not finite.
    """

    def __init__(self, path: str | os.PathLike[str], header: StreamHeader) -> None:
        super().__init__(path, header)
        self._form = RowForm(header)
        self._rates = Rates(header)
        self._portions = RowPortions(header.joints, ROWS_OF_A_CHUNK)
        self._known = {one.name: one for one in definitions_of(sorted({kind for _, kind in TOPICS.values()}))}
        self._folder = AtomicFolder(path, may_replace)
        self._trajectories = Trajectories(header, self._folder.folder)
        self._files = ExitStack()
        with self._writing():
            file = self._files.enter_context((self._folder.folder / MCAP).open("xb"))
            self._mcap = McapWriter(file, self._known)
            self._put_text(Topic.HEADER, header_to_plain(header), 0)

    def _put_block(self, record: BlockRecord) -> None:
        time_ns = self._time(record.tick)
        with self._writing():
            self._put_chunk(self._portions.rest())
            self._put_text(Topic.RECORD, record_to_plain(record), time_ns)

    def _put_rows(self, batch: RowBatch) -> None:
        self._time(int(batch.ticks[-1]))
        with self._writing():
            for portion in self._portions.put(batch):
                self._put_chunk(portion)

    def _put_chunk(self, rows: RowBatch) -> None:
        """A chunk of rows, and the trajectories that they end."""
        if not len(rows.ticks):
            return
        qd = self._rates.of(rows.ticks, rows.q).qd
        if not np.isfinite(qd).all():
            raise self.refusal("rates are not finite")
        content = self._form.records(rows.ticks, rows.q, qd, rows.block, rows.tool).tobytes()
        times = rows.ticks * self.header.tick_ns
        offsets = self._form.offsets(len(times))
        index = {channel: (times, places) for channel, places in offsets.items()}
        self._mcap.chunk(lambda: [content], len(content), index)
        for trajectory in self._trajectories.put(rows.ticks, rows.q, qd):
            self._put_trajectory(trajectory)

    def _put_trajectory(self, trajectory: Trajectory) -> None:
        length, time_ns = len(trajectory), trajectory.start_ns
        head = message_head(Topic.JOINT_TRAJECTORY, length, time_ns)
        once = np.array([time_ns]), np.array([0])
        self._mcap.chunk(
            lambda: chain([head], trajectory.parts()),
            MESSAGE_HEAD + length,
            {int(Topic.JOINT_TRAJECTORY): once},
        )

    def _put_text(self, topic: Topic, plain: object, time_ns: int) -> None:
        words = json.dumps(plain, allow_nan=False)
        self._mcap.message(topic, text_message(topic, words, time_ns), time_ns)

    def _put_end(self, complete: bool) -> None:
        with self._writing():
            self._put_chunk(self._portions.rest())
            end = {"samples": self.rows, "complete": complete, "sha256": self._mcap.digest}
            self._put_text(Topic.END, end, max(self._mcap.end_ns, 0))
            mcap = self._mcap
            text = metadata_text(mcap.counts, mcap.begin_ns, mcap.end_ns, self._known)
            mcap.finish(text)
            self._files.close()
            (self._folder.folder / METADATA).write_bytes(metadata_file(text))
        self._trajectories.close()

    def _time(self, tick: int) -> int:
        """Time of a tick in ns."""
        time_ns = tick * self.header.tick_ns
        if not 0 <= time_ns < LONGEST_TIME_NS:
            seconds = time_ns // SECOND
            raise self.refusal(f"tick {tick} is at {seconds} s, ROS has times of 0 to {2**31} s")
        return time_ns

    def _commit(self, name: Path | None) -> None:
        self._folder.commit(name)

    def _discard(self) -> None:
        # A full disk makes closing fail as well.
        with suppress(OSError):
            self._files.close()
        self._trajectories.close()
        self._folder.discard()

    @contextmanager
    def _writing(self) -> Iterator[None]:
        try:
            yield
        except OSError as cause:
            self.abort()
            raise cannot_write(self.path, cause) from cause
