"""Writer of MCAP files: topics, then chunks of messages without compression, then indexes of all of it."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Iterable, Mapping
from hashlib import sha256
from typing import IO

import numpy as np

from irlx.streams.joint_stream import Integers
from irlx.streams.rosbag.definitions import Definition
from irlx.streams.rosbag.files import HEAD, MAGIC
from irlx.streams.rosbag.mcap import CHUNK_HEAD, FOOTER, Code, mapping, record, record_head, text
from irlx.streams.rosbag.messages import TOPICS, Topic

Index = Mapping[int, tuple[Integers, Integers]]
"""Of every channel with messages in a chunk: their times (M,) in ns, and where their records begin (M,)."""

Parts = Callable[[], Iterable[bytes]]
"""Content in parts, as often as it is asked for."""


class McapWriter:
    """Writes to an open file, which it does not close. `counts` are the messages of each topic so far."""

    def __init__(self, file: IO[bytes], definitions: Mapping[str, Definition]) -> None:
        self._file = file
        self._at = 0
        self._crc = 0
        self._sum = sha256()
        self._chunks: list[bytes] = []
        self.counts = dict.fromkeys(Topic, 0)
        self.begin_ns, self.end_ns = 2**63 - 1, 0
        self._schemas = [
            record(
                Code.SCHEMA,
                struct.pack("<H", number),
                text(known.name),
                text("ros2msg"),
                text(known.text),
            )
            for number, known in enumerate(definitions.values(), 1)
        ]
        self._channels = [_channel(topic, list(definitions)) for topic in Topic]
        for part in (HEAD, *self._schemas, *self._channels):
            self._put(part)

    @property
    def digest(self) -> str:
        """SHA-256 of all that was written so far, in hexadecimal digits."""
        return self._sum.copy().hexdigest()

    def chunk(self, parts: Parts, length: int, index: Index) -> None:
        """Write records of messages as one chunk of `length` bytes, with the index of its messages."""
        crc = 0
        for part in parts():
            crc = zlib.crc32(part, crc)
        first = min(int(times.min()) for times, _ in index.values())
        last = max(int(times.max()) for times, _ in index.values())
        begin = self._at
        head = CHUNK_HEAD.pack(first, last, length, crc, 0, length)
        self._put(record_head(Code.CHUNK, len(head) + length) + head)
        for part in parts():
            self._put(part)
        end = self._at
        places = []
        for channel, (times, offsets) in index.items():
            places.append(struct.pack("<HQ", channel, self._at))
            pairs = np.stack([times, offsets], axis=1).astype("<u8").tobytes()
            self._put(record(Code.MESSAGE_INDEX, struct.pack("<HI", channel, len(pairs)), pairs))
            self.counts[Topic(channel)] += len(times)
        sizes = struct.pack("<QQQQI", first, last, begin, end - begin, 10 * len(places))
        tail = struct.pack("<QIQQ", self._at - end, 0, length, length)
        self._chunks.append(record(Code.CHUNK_INDEX, sizes, *places, tail))
        self.begin_ns, self.end_ns = min(self.begin_ns, first), max(self.end_ns, last)

    def message(self, topic: Topic, content: bytes, time_ns: int) -> None:
        """Write the record of one message as a chunk of its own."""
        once = np.array([time_ns]), np.array([0])
        self.chunk(lambda: [content], len(content), {int(topic): once})

    def finish(self, metadata: str) -> None:
        """Write what stands behind the messages; `metadata` is the text for the bag's metadata."""
        begin = self._at
        self._put(record(Code.METADATA, text("rosbag2"), mapping({"serialized_metadata": metadata})))
        place = struct.pack("<QQ", begin, self._at - begin)
        self._put(record(Code.DATA_END, struct.pack("<I", self._crc)))
        summary, offsets = self._at, b""
        self._crc = 0
        groups = {
            Code.SCHEMA: self._schemas,
            Code.CHANNEL: self._channels,
            Code.CHUNK_INDEX: self._chunks,
            Code.METADATA_INDEX: [record(Code.METADATA_INDEX, place, text("rosbag2"))],
            Code.STATISTICS: [self._statistics()],
        }
        for code, records in groups.items():
            begin = self._at
            for part in records:
                self._put(part)
            offsets += record(Code.SUMMARY_OFFSET, struct.pack("<BQQ", code, begin, self._at - begin))
        start = self._at
        self._put(offsets)
        self._put(record_head(Code.FOOTER, FOOTER.size) + FOOTER.pack(summary, start, 0)[:-4])
        self._put(struct.pack("<I", self._crc) + MAGIC)

    def _statistics(self) -> bytes:
        total, counts = sum(self.counts.values()), {t: n for t, n in self.counts.items() if n}
        numbers = total, len(self._schemas), len(self._channels), 0, 1, len(self._chunks)
        fixed = struct.pack("<QHIIIIQQI", *numbers, self.begin_ns, self.end_ns, 10 * len(counts))
        return record(Code.STATISTICS, fixed, *(struct.pack("<HQ", *pair) for pair in counts.items()))

    def _put(self, data: bytes) -> None:
        self._file.write(data)
        self._at += len(data)
        self._crc = zlib.crc32(data, self._crc)
        self._sum.update(data)


def _channel(topic: Topic, schemas: list[str]) -> bytes:
    name, kind = TOPICS[topic]
    numbers = struct.pack("<HH", topic, schemas.index(kind) + 1)
    return record(Code.CHANNEL, numbers, text(name), text("cdr"), mapping({"offered_qos_profiles": ""}))
