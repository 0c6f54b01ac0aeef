"""Strict reader of the CSV that `csv_writer` writes, some rows at a time."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

import numpy as np

from irlx.diagnostics import Place, report
from irlx.streams.csv_writer import column_line, comment
from irlx.streams.error import StreamError, broken, open_to_read
from irlx.streams.header_plain import PlainFormError, VersionError, header_from_plain
from irlx.streams.joint_stream import FORMAT_VERSION, Floats, StreamHeader
from irlx.streams.lines import all_lines, next_line
from irlx.streams.numbers import NUMBER_CHARACTERS, table_of
from irlx.streams.scan import RowBatch, ScanItem, StatedRates, StreamEnd, rising_rows

_PORTION = 1 << 19
_LARGEST = 2**53
_END = b"# end: "
_SPLITS = np.arange(1, 4)


def scan_csv(path: str | os.PathLike[str]) -> Iterator[ScanItem]:
    """Scan of a CSV file that `CsvWriter` wrote, without blocks, about 0.5 MB of text at a time.

    A file without its closing comment was cut: it is read up to its last whole line, the end being
    incomplete. Raises StreamError with the codes of `scan_irdata` once the rows before the damage are
    out; where a closing comment is there, a wrong checksum goes before any other fault of the rows.
    """
    path = Path(path)
    with open_to_read(path) as handle:
        yield from _Reader(path, handle).items()


class _Reader:
    """State of reading one file: `line` is the number of the next line, from 1."""

    def __init__(self, path: Path, handle: IO[bytes]) -> None:
        self.path = path
        self.handle = handle
        self.digest = hashlib.sha256()
        self.line = 1
        self.samples = 0
        self.last_tick = -1
        self.closing = b""
        self.rest = b""

    def items(self) -> Iterator[ScanItem]:
        header = self._header()
        yield header
        fault: StreamError | None = None
        for text in self._texts():
            if fault is None:
                batch, fault = self._batch(text, header.joints)
                if len(batch.ticks):
                    yield batch
        complete = self._closing_says()
        if fault is not None:
            raise fault
        yield StreamEnd(complete)

    def _header(self) -> StreamHeader:
        """Header of the comment lines, which the names of the columns follow."""
        comments = []
        for line in self._head_lines():
            if not line.startswith(b"# "):
                break
            comments.append(line)
            self.line += 1
        else:
            raise StreamError(report("IRL705", Place(str(self.path))))
        header = _header_of(self.path, comments)
        if line != column_line(header):
            raise self._broken("the names of the columns do not fit the header", self.line)
        self.line += 1
        self.digest.update(b"".join([*comments, line]))
        return header

    def _head_lines(self) -> Iterator[bytes]:
        for text in all_lines(self.handle):
            whole = self._whole_lines(text)
            if whole:
                yield whole

    def _texts(self) -> Iterator[bytes]:
        """Whole lines of samples in portions; a comment in the file's last line becomes `closing`."""
        last = b""
        while portion := self.handle.read(_PORTION):
            text = self._whole_lines(last + portion + next_line(self.handle))
            last = _last_line(text)
            if len(last) < len(text):
                yield from self._passing(text[: len(text) - len(last)])
        if last.startswith(b"#"):
            self.closing = last
        elif last:
            yield from self._passing(last)

    def _passing(self, text: bytes) -> Iterator[bytes]:
        yield text
        lines = text.count(b"\n")
        self.line += lines
        self.samples += lines
        self.digest.update(text)

    def _whole_lines(self, text: bytes) -> bytes:
        """Text without the last line where the file ends inside that line."""
        if text.endswith(b"\n"):
            return text
        self.rest = _last_line(text)
        whole = text[: len(text) - len(self.rest)]
        if self.rest.startswith(_END) and b"}" in self.rest:
            number = self.line + whole.count(b"\n")
            raise self._broken("the closing comment does not end its line", number)
        return whole

    def _batch(self, text: bytes, joints: int) -> tuple[RowBatch, StreamError | None]:
        """Rows of the lines before the first that is wrong, and what is wrong with that one."""
        table, fault = self._table(text, 3 + 3 * joints + 7)
        heads = table[:, [0, 2]]
        counts = (heads >= 0) & (heads < _LARGEST) & (heads == np.floor(heads))
        good = np.isfinite(table).all(axis=1) & counts.all(axis=1)
        if not good.all():
            table = table[: int(np.argmin(good))]
            fault = self._broken("ticks and block ids are counts, all values finite")
        ticks = table[:, 0].astype(np.int64)
        rows = rising_rows(ticks, self.last_tick)
        previous = int(ticks[rows - 1]) if rows else self.last_tick
        if rows < len(ticks):
            where = Place(str(self.path))
            fault = StreamError(report("IRL703", where, tick=int(ticks[rows]), previous=previous))
        self.last_tick = previous
        table = table[:rows]
        q, qd, qdd, tool = (part.copy() for part in np.split(table[:, 3:], _SPLITS * joints, axis=1))
        rates = StatedRates(table[:, 1].copy(), qd, qdd)
        return RowBatch(ticks[:rows], q, table[:, 2].astype(np.int64), tool, rates), fault

    def _table(self, text: bytes, columns: int) -> tuple[Floats, StreamError | None]:
        """Numbers of the lines before the first that has other things, and the fault of that line."""
        try:
            return table_of(text, columns), None
        except ValueError:
            # Line by line more forms of numbers are allowed, and the line that is wrong is found.
            pass
        rows: list[list[float]] = []
        fault = None
        for line in text.split(b"\n")[:-1]:
            words = line.split(b",")
            try:
                if len(words) != columns or b"".join(words).translate(None, NUMBER_CHARACTERS):
                    raise ValueError
                rows.append([float(word) for word in words])
            except ValueError:
                number = self.line + len(rows)
                fault = self._broken(f"a line of samples has {columns} numbers", number)
                break
        return np.array(rows).reshape(len(rows), columns), fault

    def _closing_says(self) -> bool:
        """What the closing comment says about completeness; checks its sums."""
        if not self.closing:
            return False
        try:
            end = json.loads(self.closing.removeprefix(_END))
            said, complete, found = int(end["samples"]), bool(end["complete"]), str(end["sha256"])
            if self.closing != comment("end", {"samples": said, "complete": complete, "sha256": found}):
                raise ValueError("it has another form")
        except (ValueError, KeyError, TypeError) as cause:
            raise self._broken("the closing comment is damaged", self.line) from cause
        expected = self.digest.hexdigest()
        where = Place(str(self.path))
        if found != expected:
            raise StreamError(report("IRL702", where, found=found[:12], expected=expected[:12]))
        if said != self.samples:
            raise StreamError(report("IRL704", where, said=said, what="samples", found=self.samples))
        if self.rest:
            raise self._broken("text follows the closing comment", self.line + 1)
        return complete

    def _broken(self, reason: str, line: int | None = None) -> StreamError:
        return broken(self.path, "CSV", reason, "" if line is None else f"line {line}")


def _last_line(text: bytes) -> bytes:
    """The last line of a text, line end included."""
    return text[text.rfind(b"\n", 0, -1) + 1 :]


def _header_of(path: Path, comments: list[bytes]) -> StreamHeader:
    plain: dict[str, Any] = {}
    for number, line in enumerate(comments, 1):
        try:
            key, separator, value = line.decode()[2:].partition(": ")
            if not separator or key in plain:
                raise ValueError("a comment is '# key: value', each key once")
            plain[key] = json.loads(value)
        except ValueError as cause:
            raise broken(path, "CSV", str(cause), f"line {number}") from cause
    try:
        return header_from_plain(plain)
    except VersionError as cause:
        raise StreamError(
            report("IRL706", Place(str(path)), found=cause.found, known=FORMAT_VERSION)
        ) from cause
    except PlainFormError as cause:
        raise broken(path, "CSV", str(cause), "header") from cause
