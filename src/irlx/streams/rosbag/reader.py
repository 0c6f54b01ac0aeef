"""Strict reader of the bags that `RosbagWriter` writes, a chunk at a time, in the order of the file."""

from __future__ import annotations

import json
import os
import struct
import zlib
from collections.abc import Iterator
from hashlib import sha256
from pathlib import Path
from typing import IO, Any

import numpy as np

from irlx.diagnostics import Place, report
from irlx.streams.error import StreamError, broken, cannot_read, open_to_read
from irlx.streams.header_plain import PlainFormError, VersionError, header_from_plain, record_from_plain
from irlx.streams.joint_stream import FORMAT_VERSION, BlockRecord, StreamHeader
from irlx.streams.rates import Rates
from irlx.streams.rosbag.files import FORMAT, HEAD, MAGIC, MCAP, METADATA
from irlx.streams.rosbag.mcap import CHUNK_HEAD, FOOTER, RECORD_HEAD, Code, mapping, parsed_head, text
from irlx.streams.rosbag.messages import MESSAGE_HEAD, ROWS_OF_A_CHUNK, RowForm, Topic, text_message
from irlx.streams.rosbag.metadata import metadata_file
from irlx.streams.scan import RowBatch, ScanItem, StatedRates, StreamEnd, rising_rows

_PORTION = 1 << 20
_LONGEST_TEXT = 1 << 26
_END_KINDS = {"samples": int, "complete": bool, "sha256": str}
_TAIL = RECORD_HEAD + FOOTER.size + len(MAGIC)


def scan(path: Path) -> Iterator[ScanItem]:
    """Scan of a bag that `RosbagWriter` wrote: block records and rows in the order in which they came.

    Needs no package of ROS. Trajectories are passed over: their bytes count in the checksum. A bag states
    no accelerations; those of the batches are the differences of its velocities. A bag whose MCAP file was
    cut is read up to its last whole chunk, the end being incomplete. Raises StreamError once what stands
    before the damage is out: IRL001, IRL002 where the bag cannot be read, IRL701 where it is damaged or not
    of irlx, IRL702 for a wrong checksum, IRL703 for ticks that do not rise, IRL704 for another number of
    rows, IRL705 where not even the header is whole, IRL706 for another version.
    """
    try:
        os.stat(path)
    except (OSError, ValueError) as cause:
        raise cannot_read(path, cause) from cause
    if not path.is_dir():
        raise broken(path, FORMAT, "it is a file, a bag is a folder")
    if not (path / MCAP).is_file():
        raise broken(path, FORMAT, f"{MCAP} is missing")
    metadata = None
    if (path / METADATA).exists():
        with open_to_read(path / METADATA) as handle:
            metadata = handle.read(min(os.fstat(handle.fileno()).st_size, _LONGEST_TEXT))
    with open_to_read(path / MCAP) as handle:
        try:
            yield from _Reader(path, handle, metadata).items()
        except VersionError as cause:
            raise StreamError(
                report("IRL706", Place(str(path)), found=cause.found, known=FORMAT_VERSION)
            ) from cause
        except (ValueError, struct.error, RecursionError) as cause:
            raise broken(path, FORMAT, f"{MCAP}: {cause}") from cause


class _EndsEarly(Exception):
    """The file has fewer bytes than it says."""


class _Source:
    """A file that is read from its beginning on; `crc` and `sum` are those of what was read.

    `sealed` tells whether the file's last bytes are those of a whole one.
    """

    def __init__(self, handle: IO[bytes]) -> None:
        self._handle = handle
        self.left = os.fstat(handle.fileno()).st_size
        handle.seek(max(0, self.left - len(MAGIC)))
        self.sealed = handle.read(len(MAGIC)) == MAGIC
        handle.seek(0)
        self.crc = 0
        self.sum = sha256()

    def take(self, length: int) -> bytes:
        """The next bytes; raises _EndsEarly where there are fewer."""
        data = self._handle.read(length) if length <= self.left else b""
        if len(data) < length:
            raise _EndsEarly
        self.left -= length
        self.crc = zlib.crc32(data, self.crc)
        self.sum.update(data)
        return data

    def skip(self, length: int, crc: int = 0) -> int:
        """Pass bytes in portions; gives `crc` with them counted in."""
        if length > self.left:
            raise _EndsEarly
        while length:
            part = self.take(min(length, _PORTION))
            crc = zlib.crc32(part, crc)
            length -= len(part)
        return crc


class _Reader:
    """State of reading one bag."""

    def __init__(self, path: Path, handle: IO[bytes], metadata: bytes | None) -> None:
        self.path = path
        self.source = _Source(handle)
        self.metadata = metadata
        self.header: StreamHeader | None = None
        self.last_tick = -1
        self.last_block_tick = 0
        self.samples = 0
        self.end: StreamEnd | None = None

    def items(self) -> Iterator[ScanItem]:
        try:
            yield from self._whole_items()
        except _EndsEarly:
            if self.source.sealed or self.end is not None:
                raise ValueError("it ends early") from None
            if self.header is None:
                raise StreamError(report("IRL705", Place(str(self.path)))) from None
            yield StreamEnd(False)

    def _whole_items(self) -> Iterator[ScanItem]:
        if self.source.take(len(HEAD)) != HEAD:
            raise ValueError("irlx did not write this file")
        while True:
            crc, digest = self.source.crc, self.source.sum.copy()
            code, length = parsed_head(self.source.take(RECORD_HEAD))
            if code == Code.CHUNK and self.end is None:
                yield from self._chunk(length, digest)
            elif code in (Code.SCHEMA, Code.CHANNEL, Code.MESSAGE_INDEX):
                self.source.skip(length)
            elif code == Code.METADATA:
                self._check_metadata(length)
            elif code == Code.DATA_END:
                break
            else:
                raise ValueError(f"a record of code {code} stands where none is due")
        self._check_tail(length, crc)
        if self.end is None:
            raise ValueError("its end is missing")
        yield self.end

    def _chunk(self, length: int, digest: Any) -> Iterator[ScanItem]:
        """What a chunk gives; `digest` is the one of all before it."""
        _, _, size, crc, compression, again = CHUNK_HEAD.unpack(self.source.take(CHUNK_HEAD.size))
        if compression or size != again or size != length - CHUNK_HEAD.size or size < MESSAGE_HEAD:
            raise ValueError("a chunk has another form than irlx gives it")
        head = self.source.take(MESSAGE_HEAD)
        code, _ = parsed_head(head[:RECORD_HEAD])
        topic = int.from_bytes(head[RECORD_HEAD : RECORD_HEAD + 2], "little")
        if code != Code.MESSAGE or topic not in set(Topic):
            raise ValueError("a chunk has other things than messages of irlx")
        rest = size - MESSAGE_HEAD
        if topic == Topic.JOINT_TRAJECTORY:
            if self.source.skip(rest, zlib.crc32(head)) != crc:
                raise ValueError("the checksum of a trajectory is wrong")
            return
        if size > _LONGEST_TEXT:
            raise ValueError("a chunk is too long")
        data = head + self.source.take(rest)
        if zlib.crc32(data) != crc:
            raise ValueError("the checksum of a chunk is wrong")
        if topic == Topic.JOINT_STATES:
            yield from self._rows(data)
        else:
            yield from self._text(Topic(topic), data, digest)

    def _rows(self, data: bytes) -> Iterator[ScanItem]:
        if self.header is None:
            raise ValueError("the header is due first")
        if len(data) > ROWS_OF_A_CHUNK * len(self.form):
            raise ValueError("a chunk has too many rows")
        ticks, q, qd, block, tool = self.form.read(data)
        with np.errstate(all="ignore"):
            stated = self.accelerations.of(ticks, qd)
        batch = RowBatch(ticks, q, block, tool, StatedRates(stated.t, qd, stated.qd))
        rows = rising_rows(ticks, self.last_tick)
        good = np.isfinite(np.concatenate([q, qd, tool], axis=1)).all(axis=1)
        whole = rows if good[:rows].all() else int(np.argmin(good[:rows]))
        if whole:
            self.last_tick = int(ticks[whole - 1])
            self.samples += whole
            yield batch.part(slice(0, whole))
        if whole < rows:
            raise ValueError(f"the row of tick {ticks[whole]} has values that are not finite")
        if rows < len(ticks):
            place, tick = Place(str(self.path)), int(ticks[rows])
            raise StreamError(report("IRL703", place, tick=tick, previous=self.last_tick))

    def _text(self, topic: Topic, data: bytes, digest: Any) -> Iterator[ScanItem]:
        """Header, record or end: JSON in a message that has no other parts."""
        time_ns = int.from_bytes(data[MESSAGE_HEAD - 8 : MESSAGE_HEAD], "little")
        words = data[MESSAGE_HEAD + 8 : -1].decode()
        if topic in (Topic.TOOL_POSE, Topic.BLOCK) or text_message(topic, words, time_ns) != data:
            raise ValueError("a message has another form than irlx gives it")
        plain = json.loads(words)
        if (topic == Topic.HEADER) != (self.header is None):
            raise ValueError("one header is due, before all else")
        if topic == Topic.HEADER:
            self.header = header_from_plain(plain)
            self.form = RowForm(self.header)
            # Differences of velocities.
            self.accelerations = Rates(self.header)
            yield self.header
        elif topic == Topic.RECORD:
            yield self._record(plain)
        else:
            self._take_end(plain, digest.hexdigest())

    def _record(self, plain: object) -> BlockRecord:
        try:
            record = record_from_plain(plain)
        except PlainFormError as cause:
            raise ValueError(f"a record of tick {self.last_block_tick} or later: {cause}") from cause
        if record.tick < self.last_block_tick:
            raise ValueError(f"a record of tick {record.tick} follows one of tick {self.last_block_tick}")
        self.last_block_tick = record.tick
        return record

    def _take_end(self, plain: object, expected: str) -> None:
        if not isinstance(plain, dict) or {key: type(value) for key, value in plain.items()} != _END_KINDS:
            raise ValueError("an end has samples, complete and sha256")
        place, said = Place(str(self.path)), plain["samples"]
        if plain["sha256"] != expected:
            found = plain["sha256"][:12]
            raise StreamError(report("IRL702", place, found=found, expected=expected[:12]))
        if said != self.samples:
            raise StreamError(report("IRL704", place, said=said, what="samples", found=self.samples))
        self.end = StreamEnd(plain["complete"])

    def _check_metadata(self, length: int) -> None:
        """The file beside says the same as the record of this length."""
        if length > _LONGEST_TEXT:
            raise ValueError("its metadata are too long")
        found = self.source.take(length)
        if self.metadata is None:
            raise ValueError(f"{METADATA} is missing beside it")
        lines = self.metadata.decode().splitlines(keepends=True)[1:]
        words = "".join(line[2:] for line in lines)
        due = text("rosbag2") + mapping({"serialized_metadata": words})
        if found != due or metadata_file(words) != self.metadata:
            raise ValueError(f"it does not fit {METADATA}")

    def _check_tail(self, length: int, crc: int) -> None:
        """Checksums of the data, `crc`, and of the summary; the magic bytes at the end."""
        if length != 4 or self.source.take(4) != struct.pack("<I", crc):
            raise ValueError("the checksum of its data is wrong")
        if self.source.left < _TAIL:
            raise _EndsEarly
        self.source.crc = 0
        self.source.skip(self.source.left - 4 - len(MAGIC))
        crc = self.source.crc
        if self.source.take(4) != struct.pack("<I", crc) or self.source.take(len(MAGIC)) != MAGIC:
            raise ValueError("the checksum of its summary is wrong")
