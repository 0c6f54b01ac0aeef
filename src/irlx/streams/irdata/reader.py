"""Strict reader of IRDATA-like files: what breaks the format is named with its record number."""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path

from irlx.diagnostics import Place, report
from irlx.streams.error import StreamError, broken, open_to_read
from irlx.streams.header_plain import PlainFormError, VersionError
from irlx.streams.irdata.block import block_of
from irlx.streams.irdata.codes import BLOCK_OF_CODE, END
from irlx.streams.irdata.header import HeaderParser
from irlx.streams.irdata.record import Record, RecordError, parse_record
from irlx.streams.irdata.samples import is_sample, parse_samples
from irlx.streams.joint_stream import FORMAT_VERSION, BlockRecord, JointStream, StreamHeader
from irlx.streams.lines import portions
from irlx.streams.scan import RowBatch, ScanItem, StreamEnd, collect, no_rows, rising_rows

_CHUNK = 1 << 19
_STRING = re.compile(rb'"(?:[^"\\]|\\.)*"')


def read_irdata(path: str | os.PathLike[str]) -> JointStream:
    """Stream of an IRDATA-like file; raises what `scan_irdata` raises."""
    return collect(scan_irdata(path))


def scan_irdata(path: str | os.PathLike[str]) -> Iterator[ScanItem]:
    """Scan of an IRDATA-like file, items in the order of the file, about 0.5 MB of text at a time.

    A file that was cut anywhere after its header is read up to its last whole record, the end being
    incomplete. Raises StreamError once what stands before the damage is out: IRL001, IRL002, IRL007
    where the file cannot be read; IRL701 with record number and reason where it breaks the format;
    IRL702 wrong checksum; IRL703 ticks that do not rise; IRL704 wrong count of samples; IRL705 cut
    inside the header; IRL706 other version.
    """
    path = Path(path)
    reader = _Reader(path)
    with open_to_read(path) as handle:
        for lines in portions(handle, _CHUNK):
            yield from reader.take(lines)
    yield reader.stream_end()


class _Reader:
    """State of reading one file: which record is due, and what the records above say together."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.number = 1
        self.digest = hashlib.sha256()
        self.head = HeaderParser()
        self.samples = 0
        self.last_tick = -1
        self.last_block_tick = 0
        self.end: StreamEnd | None = None

    def take(self, lines: list[bytes]) -> Iterator[ScanItem]:
        """Read the next lines; where the file ends inside a record, that record is left out."""
        rest = b"" if lines[-1].endswith((b"\n", b" ;")) else lines.pop()
        for is_samples, group in groupby(lines, is_sample):
            if is_samples and self.head.header is not None and self.end is None:
                yield from self._take_samples(list(group), self.head.header.joints)
                continue
            for line in group:
                found = self._take_record(line)
                if found is not None:
                    yield found
        self._check_rest(rest)

    def _take_samples(self, lines: list[bytes], joints: int) -> Iterator[RowBatch]:
        batch, fault = self._parsed(lines, joints)
        rows = rising_rows(batch.ticks, self.last_tick)
        falling = batch.ticks[rows:]
        self.digest.update(b"".join(lines[:rows]))
        self.number += rows
        self.samples += rows
        if rows:
            self.last_tick = int(batch.ticks[rows - 1])
            yield batch.part(slice(0, rows))
        if falling.size:
            where = Place(str(self.path), key=f"record {self.number}")
            tick = int(falling[0])
            raise StreamError(report("IRL703", where, tick=tick, previous=self.last_tick))
        if fault is not None:
            raise self._broken(str(fault)) from fault

    def _parsed(self, lines: list[bytes], joints: int) -> tuple[RowBatch, RecordError | None]:
        """Rows of the lines before the first that is wrong, and what is wrong with that one."""
        try:
            return parse_samples(lines, self.number, joints), None
        except RecordError as cause:
            fault = cause
        whole = 0
        for line in lines:
            try:
                parse_samples([line], self.number + whole, joints)
            except RecordError as cause:
                fault = cause
                break
            whole += 1
        return (parse_samples(lines[:whole], self.number, joints) if whole else no_rows(joints)), fault

    def _take_record(self, line: bytes) -> StreamHeader | BlockRecord | None:
        """Read a record that is no sample; the item that it is, or completes."""
        found: StreamHeader | BlockRecord | None = None
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
                found = self.head.header
            else:
                found = self._block(record)
        except VersionError as cause:
            raise StreamError(
                report("IRL706", Place(str(self.path)), found=cause.found, known=FORMAT_VERSION)
            ) from cause
        except (RecordError, PlainFormError) as cause:
            raise self._broken(str(cause)) from cause
        self.digest.update(line)
        self.number += 1
        return found

    def _block(self, record: Record) -> BlockRecord:
        if record.code not in BLOCK_OF_CODE:
            raise RecordError(f"no record has the code {record.code:03d} here")
        found = block_of(record)
        if found.tick < self.last_block_tick:
            raise RecordError(f"its tick {found.tick} is before that of the block above")
        self.last_block_tick = found.tick
        return found

    def _take_end(self, record: Record) -> None:
        if self.head.header is None:
            raise RecordError("the end record stands inside the header")
        fields = record.fields()
        if tuple(fields) != ("samples", "complete", "sha256") or not isinstance(fields["complete"], bool):
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
        self.end = StreamEnd(fields["complete"])

    def _check_rest(self, rest: bytes) -> None:
        """Refuse what cannot be the beginning of a record that was cut."""
        if b";" in _STRING.sub(b"", rest):
            raise self._broken("text follows the end of the record")
        if rest and self.end is not None:
            raise self._broken("it follows the end record")

    def _broken(self, reason: str) -> StreamError:
        return broken(self.path, "IRDATA-like", reason, f"record {self.number}")

    def stream_end(self) -> StreamEnd:
        """What the file says of its end; raises StreamError IRL705 where it ended inside its header."""
        if self.head.header is None:
            raise StreamError(report("IRL705", Place(str(self.path))))
        return self.end or StreamEnd(complete=False)
