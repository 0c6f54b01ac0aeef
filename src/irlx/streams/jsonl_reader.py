"""Strict reader of the JSON Lines that `jsonl_writer` writes, some lines at a time."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import IO, Any, NoReturn

import numpy as np

from irlx.diagnostics import Place, report
from irlx.streams.error import StreamError, broken, open_to_read
from irlx.streams.header_plain import PlainFormError, VersionError, header_from_plain, record_from_plain
from irlx.streams.joint_stream import FORMAT_VERSION, Floats, StreamHeader
from irlx.streams.jsonl_writer import SAMPLE_KEYS
from irlx.streams.lines import all_lines
from irlx.streams.scan import RowBatch, ScanItem, StatedRates, StreamEnd, rising_rows

_LINES = 1024
_LARGEST = 2**53
_KEYS = set(SAMPLE_KEYS)


class _LineError(ValueError):
    """What is wrong with a line."""


def scan_jsonl(path: str | os.PathLike[str]) -> Iterator[ScanItem]:
    """Scan of a JSON Lines file that `JsonlWriter` wrote, some lines at a time.

    A file without its end line was cut: it is read up to its last whole line, the end being incomplete.
    Raises StreamError with the codes of `scan_irdata` once what stands before the damage is out; where an
    end line is there, a wrong checksum goes before any other fault behind the header.
    """
    path = Path(path)
    with open_to_read(path) as handle:
        yield from _Reader(path, handle).items()


class _Reader:
    """State of reading one file: `line` is the number of the line that is looked at, from 1."""

    def __init__(self, path: Path, handle: IO[bytes]) -> None:
        self.path = path
        self.handle = handle
        self.digest = hashlib.sha256()
        self.line = 0
        self.samples = 0
        self.last_tick = -1
        self.last_block_tick = 0
        self.header: StreamHeader | None = None
        self.end: dict[str, Any] | None = None

    def items(self) -> Iterator[ScanItem]:
        fault: StreamError | None = None
        given = all_lines(self.handle)
        while lines := list(islice(given, _LINES)):
            for group in _groups(lines):
                if self.end is not None:
                    raise self._broken("text follows the end", self.line + 1)
                items, fault = self._items(group, fault)
                yield from items
        self._check_end(fault)
        yield StreamEnd(bool(self.end and self.end["complete"]))

    def _items(
        self, lines: list[bytes], fault: StreamError | None
    ) -> tuple[list[ScanItem], StreamError | None]:
        """What lines give, none of it behind a fault; with the first fault so far."""
        first = self.line + 1
        if self.header is not None and not lines[-1].endswith(b"\n"):
            if _begins_end(lines[-1]) and b"}}" in lines[-1]:
                raise fault or self._broken("the last line has no line feed", first)
            return [], fault
        self.line += len(lines)
        if self.header is None:
            return [self._header(lines[0])], None
        if _begins_end(lines[0]):
            self.end = self._end(lines[0], fault)
            return [], fault
        for line in lines:
            self.digest.update(line)
        if not lines[0].startswith(b'{"record"'):
            self.samples += len(lines)
        if fault is not None:
            return [], fault
        if lines[0].startswith(b'{"record"'):
            return self._record(lines[0])
        return self._rows(lines, first)

    def _header(self, line: bytes) -> StreamHeader:
        if not line.endswith(b"\n"):
            raise StreamError(report("IRL705", Place(str(self.path))))
        try:
            self.header = header_from_plain(_entry(line, "header"))
        except VersionError as cause:
            found, known = cause.found, FORMAT_VERSION
            raise StreamError(report("IRL706", Place(str(self.path)), found=found, known=known)) from cause
        except (_LineError, PlainFormError) as cause:
            raise self._broken(str(cause), 1) from cause
        self.digest.update(line)
        return self.header

    def _record(self, line: bytes) -> tuple[list[ScanItem], StreamError | None]:
        """A block record, or what is wrong with it."""
        try:
            record = record_from_plain(_entry(line, "record"))
        except (_LineError, PlainFormError) as cause:
            return [], self._broken(str(cause), self.line)
        if record.tick < self.last_block_tick:
            return [], self._broken(f"its tick {record.tick} is before that of the block above", self.line)
        self.last_block_tick = record.tick
        return [record], None

    def _rows(self, lines: list[bytes], first: int) -> tuple[list[ScanItem], StreamError | None]:
        """Rows of sample lines before the first that is wrong, and what is wrong with that one."""
        assert self.header is not None
        fault: StreamError | None = None
        try:
            batch = _batch(lines, self.header.joints)
        except _LineError:
            good = 0
            for line in lines:
                try:
                    _batch([line], self.header.joints)
                except _LineError as cause:
                    fault = self._broken(str(cause), first + good)
                    break
                good += 1
            if not good:
                return [], fault
            batch = _batch(lines[:good], self.header.joints)
        rows = rising_rows(batch.ticks, self.last_tick)
        if rows < len(batch.ticks):
            previous = int(batch.ticks[rows - 1]) if rows else self.last_tick
            place = Place(str(self.path), key=f"line {first + rows}")
            fault = StreamError(report("IRL703", place, tick=int(batch.ticks[rows]), previous=previous))
        if not rows:
            return [], fault
        self.last_tick = int(batch.ticks[rows - 1])
        return [batch.part(slice(0, rows))], fault

    def _end(self, line: bytes, fault: StreamError | None) -> dict[str, Any]:
        try:
            end = _entry(line, "end")
        except _LineError as cause:
            raise fault or self._broken(str(cause), self.line) from cause
        kinds = {"samples": int, "complete": bool, "sha256": str}
        if not isinstance(end, dict) or {key: type(value) for key, value in end.items()} != kinds:
            raise fault or self._broken("an end has samples, complete and sha256", self.line)
        return end

    def _check_end(self, fault: StreamError | None) -> None:
        if self.header is None:
            raise StreamError(report("IRL705", Place(str(self.path))))
        where = Place(str(self.path))
        if self.end is not None:
            said, digest = self.end["sha256"], self.digest.hexdigest()
            if digest != said:
                raise StreamError(report("IRL702", where, found=said[:12], expected=digest[:12]))
        if fault is not None:
            raise fault
        if self.end is not None and self.samples != self.end["samples"]:
            number = self.end["samples"]
            raise StreamError(report("IRL704", where, said=number, what="samples", found=self.samples))

    def _broken(self, reason: str, line: int) -> StreamError:
        return broken(self.path, "JSON Lines", reason, f"line {line}")


def _groups(lines: list[bytes]) -> Iterator[list[bytes]]:
    """Lines of samples that follow each other together, every other line by itself."""
    group: list[bytes] = []
    for line in lines:
        if line.startswith(b'{"tick"') and line.endswith(b"\n"):
            group.append(line)
            continue
        if group:
            yield group
        group = []
        yield [line]
    if group:
        yield group


def _begins_end(line: bytes) -> bool:
    return line.startswith(b'{"end"')


def _loaded(text: bytes) -> Any:
    try:
        return json.loads(text.decode("utf-8"), parse_constant=_no_number)
    except RecursionError:
        raise _LineError("it is nested too deeply") from None
    except ValueError as cause:
        raise _LineError(f"it is no JSON ({cause})") from None


def _no_number(word: str) -> NoReturn:
    raise ValueError(f"{word} is no number of JSON")


def _entry(line: bytes, key: str) -> Any:
    """Value of an object that has this entry alone."""
    plain = _loaded(line)
    if not isinstance(plain, dict) or set(plain) != {key}:
        raise _LineError(f"an object with the entry '{key}' alone is due")
    return plain[key]


def _batch(lines: list[bytes], joints: int) -> RowBatch:
    """Rows of sample lines. Raises _LineError, which does not say in which line."""
    samples = _loaded(b"[" + b",".join(lines) + b"]")
    if len(samples) != len(lines) or not all(isinstance(row, dict) and set(row) == _KEYS for row in samples):
        raise _LineError("an object with the entries " + ", ".join(SAMPLE_KEYS) + " is due")
    for key in ("tick", "block"):
        if not all(type(row[key]) is int and 0 <= row[key] < _LARGEST for row in samples):
            raise _LineError(f"{key}: needs a count")
    ticks, block = (np.array([row[key] for row in samples], dtype=np.int64) for key in ("tick", "block"))
    q, qd, qdd = (_table(samples, key, joints) for key in ("q", "qd", "qdd"))
    t = _numbers([row["t"] for row in samples], "t")
    return RowBatch(ticks, q, block, _table(samples, "tool", 7), StatedRates(t, qd, qdd))


def _table(samples: list[dict[str, Any]], key: str, width: int) -> Floats:
    rows = [row[key] for row in samples]
    if not all(type(row) is list and len(row) == width for row in rows):
        raise _LineError(f"{key}: needs {width} numbers")
    return _numbers([value for row in rows for value in row], key).reshape(len(rows), width)


def _numbers(values: list[Any], key: str) -> Floats:
    if not {type(value) for value in values} <= {float, int}:
        raise _LineError(f"{key}: needs numbers")
    try:
        found = np.array(values, dtype=np.float64)
    except OverflowError:
        raise _LineError(f"{key}: a number is too large") from None
    if not np.isfinite(found).all():
        raise _LineError(f"{key}: a number is too large")
    return found
