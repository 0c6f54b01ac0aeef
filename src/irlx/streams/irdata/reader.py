"""Strict reader of IRDATA-like files: what breaks the format is named with its record number."""

from __future__ import annotations

import hashlib
import os
import re
from itertools import groupby
from pathlib import Path

import numpy as np

from irlx.diagnostics import Place, report
from irlx.streams.error import StreamError, broken, open_to_read
from irlx.streams.header_plain import PlainFormError, VersionError
from irlx.streams.irdata.block import block_of
from irlx.streams.irdata.codes import BLOCK_OF_CODE, END
from irlx.streams.irdata.header import HeaderParser
from irlx.streams.irdata.record import Record, RecordError, parse_record
from irlx.streams.irdata.samples import MARK, SampleBatch, parse_samples
from irlx.streams.joint_stream import FORMAT_VERSION, BlockRecord, JointStream, StreamHeader

_CHUNK = 1 << 20
_LONGEST_NUMBER = 24
_STRING = re.compile(rb'"(?:[^"\\]|\\.)*"')


def read_irdata(path: str | os.PathLike[str]) -> JointStream:
    """Stream of an IRDATA-like file.

    A file that was cut anywhere after its header is read up to its last whole record, `complete`
    being False. Raises StreamError: IRL001, IRL002, IRL007 where the file cannot be read; IRL701
    with record number and reason where it breaks the format; IRL702 wrong checksum; IRL703 ticks
    that do not rise; IRL704 wrong count of samples; IRL705 cut inside the header; IRL706 other
    version.
    """
    path = Path(path)
    reader = _Reader(path)
    with open_to_read(path) as handle:
        while lines := handle.readlines(_CHUNK):
            reader.take(lines)
    return reader.stream()


class _Reader:
    """State of reading one file: what has been read, and which record is due."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.number = 1
        self.digest = hashlib.sha256()
        self.head = HeaderParser()
        self.records: list[BlockRecord] = []
        self.batches: list[SampleBatch] = []
        self.samples = 0
        self.last_tick = -1
        self.end: Record | None = None

    def take(self, lines: list[bytes]) -> None:
        """Read the next lines; where the file ends inside a record, that record is left out."""
        rest = b"" if lines[-1].endswith((b"\n", b" ;")) else lines.pop()
        for is_samples, group in groupby(lines, _is_sample):
            run = list(group)
            if is_samples and self.head.header is not None and self.end is None:
                self._take_samples(run, self.head.header)
                continue
            for line in run:
                self._take_record(line)
        self._check_rest(rest)

    def _take_samples(self, lines: list[bytes], header: StreamHeader) -> None:
        try:
            batch = parse_samples(lines, self.number, header.joints)
        except RecordError as cause:
            if len(lines) == 1:
                raise self._broken(str(cause)) from cause
            for line in lines:
                self._take_samples([line], header)
            raise
        before = np.concatenate(([self.last_tick], batch.ticks[:-1]))
        falls = batch.ticks <= before
        if falls.any():
            row = int(np.argmax(falls))
            self.number += row
            where = Place(str(self.path), key=f"record {self.number}")
            raise StreamError(report("IRL703", where, tick=int(batch.ticks[row]), previous=int(before[row])))
        self.digest.update(b"".join(lines))
        self.batches.append(batch)
        self.number += len(lines)
        self.samples += len(lines)
        self.last_tick = int(batch.ticks[-1])

    def _take_record(self, line: bytes) -> None:
        try:
            record = parse_record(line)
            if record.number != self.number:
                raise RecordError(f"its number is {record.number}, {self.number} is due")
            if self.end is not None:
                raise RecordError("it follows the end record")
            if record.code == END:
                self._take_end(record)
            elif self.head.header is None:
                self.head.add(record)
            else:
                self._take_block(record)
        except VersionError as cause:
            raise StreamError(
                report("IRL706", Place(str(self.path)), found=cause.found, known=FORMAT_VERSION)
            ) from cause
        except (RecordError, PlainFormError) as cause:
            raise self._broken(str(cause)) from cause
        self.digest.update(line)
        self.number += 1

    def _take_block(self, record: Record) -> None:
        if record.code not in BLOCK_OF_CODE:
            raise RecordError(f"no record has the code {record.code:03d} here")
        found = block_of(record)
        if self.records and found.tick < self.records[-1].tick:
            raise RecordError(f"its tick {found.tick} is before that of the block above")
        self.records.append(found)

    def _take_end(self, record: Record) -> None:
        if self.head.header is None:
            raise RecordError("the end record stands inside the header")
        fields = record.fields()
        if tuple(fields) != ("samples", "complete", "sha256") or type(fields["complete"]) is not bool:
            raise RecordError("the operands of the end record are samples, complete and sha256")
        where = Place(str(self.path), key=f"record {self.number}")
        expected = self.digest.hexdigest()
        if fields["sha256"] != expected:
            raise StreamError(
                report("IRL702", where, found=str(fields["sha256"])[:12], expected=expected[:12])
            )
        if fields["samples"] != self.samples:
            said = fields["samples"]
            raise StreamError(report("IRL704", where, said=said, what="samples", found=self.samples))
        self.end = record

    def _check_rest(self, rest: bytes) -> None:
        """Refuse what cannot be the beginning of a record that was cut."""
        if b";" in _STRING.sub(b"", rest):
            raise self._broken("text follows the end of the record")
        if rest and self.end is not None:
            raise self._broken("it follows the end record")

    def _broken(self, reason: str) -> StreamError:
        return broken(self.path, "IRDATA-like", reason, f"record {self.number}")

    def stream(self) -> JointStream:
        """What was read; raises StreamError IRL705 where the file ended inside its header."""
        header = self.head.header
        if header is None:
            raise StreamError(report("IRL705", Place(str(self.path))))
        empty = SampleBatch(
            np.zeros(0, np.int64), np.zeros((0, header.joints)), np.zeros(0, np.int64), np.zeros((0, 7))
        )
        ticks, q, block, tool = (np.concatenate(parts) for parts in zip(empty, *self.batches, strict=True))
        complete = self.end is not None and self.end.fields()["complete"] is True
        return JointStream(header, tuple(self.records), ticks, q, block, tool, complete)


def _is_sample(line: bytes) -> bool:
    return line.find(MARK, 0, _LONGEST_NUMBER) > 0
