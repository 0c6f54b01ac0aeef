"""Reader of NPZ files, some rows at a time: the arrays are read side by side, none of them as a whole."""

from __future__ import annotations

import errno
import io
import json
import os
import re
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import ExitStack
from itertools import pairwise
from math import prod
from pathlib import Path
from typing import IO, Any

import numpy as np

from irlx.diagnostics import Place, report
from irlx.streams.error import StreamError, broken, open_to_read
from irlx.streams.header_plain import PlainFormError, VersionError, header_from_plain, record_from_plain
from irlx.streams.joint_stream import FORMAT_VERSION, BlockRecord, Integers, StreamHeader
from irlx.streams.scan import RowBatch, ScanItem, StatedRates, StreamEnd, rising_rows

_PORTION = 4096
_REST = 1 << 16
_HEAD = re.compile(
    rb"\{'descr': '(?P<kind>[<>|][biufc][0-9]{1,2})', 'fortran_order': (?P<columns>True|False), "
    rb"'shape': \((?P<shape>(?:[0-9]{1,18}, ?)*(?:[0-9]{1,18})?)\), \} *\n"
)
_LONGEST_HEAD = 10_000
_LONGEST_MEMBER = 1 << 28
"""Bytes of what is read as a whole, which a compressed file can be much shorter than."""
_DAMAGE = (zipfile.BadZipFile, zlib.error, KeyError, ValueError, EOFError, NotImplementedError, RuntimeError)


def scan_npz(path: str | os.PathLike[str]) -> Iterator[ScanItem]:
    """Scan of an NPZ file that `NpzWriter` wrote: all block records, then the rows in portions.

    Raises StreamError once the rows before the damage are out: IRL001, IRL002, IRL007 where the file
    cannot be read, IRL701 where it is damaged, IRL703 for ticks that do not rise, IRL706 for another
    version. Checksums of arrays are compared at their ends.
    """
    path = Path(path)
    try:
        with open_to_read(path) as handle:
            yield from _archive_items(path, handle)
    except VersionError as cause:
        raise StreamError(
            report("IRL706", Place(str(path)), found=cause.found, known=FORMAT_VERSION)
        ) from cause
    except PlainFormError as cause:
        raise broken(path, "NPZ", str(cause), "meta") from cause
    except _DAMAGE as cause:
        raise broken(path, "NPZ", f"it is damaged ({cause})") from cause


def _archive_items(path: Path, handle: IO[bytes]) -> Iterator[ScanItem]:
    try:
        with zipfile.ZipFile(handle) as archive, ExitStack() as members:
            yield from _items(path, archive, members)
    except OSError as cause:
        # A damaged directory can send the reader to an offset before the file's beginning.
        if cause.errno == errno.EINVAL:
            raise zipfile.BadZipFile("its directory is damaged") from cause
        raise


def _items(path: Path, archive: zipfile.ZipFile, members: ExitStack) -> Iterator[ScanItem]:
    header, records, said, complete = _meta(archive)
    names = np.asarray(_member(archive, "joint_names")).ravel().tolist()
    # Numpy's texts lose zero characters at their end.
    if names != [name.rstrip("\0") for name in header.joint_names]:
        raise PlainFormError("header.joint_names: those of the member 'joint_names' are others")
    arrays = {
        key: _Array(key, members.enter_context(archive.open(f"{key}.npy")))
        for key in ("t", "q", "qd", "qdd", "tool", "block")
    }
    ticks = _Ticks(said, arrays["q"].rows)
    for key, tail in {"q": (header.joints,), "block": (), "tool": (7,)}.items():
        arrays[key].check((ticks.rows, *tail), np.int64 if key == "block" else np.float64)
    for key, tail in {"t": (), "qd": (header.joints,), "qdd": (header.joints,)}.items():
        arrays[key].check((ticks.rows, *tail), np.float64)
    yield header
    yield from records
    last = -1
    for start in range(0, ticks.rows, _PORTION):
        batch = _batch(ticks, arrays, start, min(start + _PORTION, ticks.rows))
        rows = rising_rows(batch.ticks, last)
        if rows:
            last = int(batch.ticks[rows - 1])
            yield batch.part(slice(0, rows))
        if rows < len(batch.ticks):
            tick = int(batch.ticks[rows])
            raise StreamError(report("IRL703", Place(str(path)), tick=tick, previous=last))
    for array in arrays.values():
        array.finish()
    yield StreamEnd(complete)


def _batch(ticks: _Ticks, arrays: dict[str, _Array], start: int, stop: int) -> RowBatch:
    parts = {key: array.take(stop - start) for key, array in arrays.items()}
    rates = StatedRates(parts["t"], parts["qd"], parts["qdd"])
    return RowBatch(ticks.part(start, stop), parts["q"], parts["block"], parts["tool"], rates)


def _meta(archive: zipfile.ZipFile) -> tuple[StreamHeader, list[BlockRecord], Integers, bool]:
    """Header, block records, runs of ticks (R, 2) and the complete flag."""
    meta = json.loads(str(_member(archive, "meta").item()))
    if not isinstance(meta, dict) or set(meta) != {"header", "records", "ticks", "complete"}:
        raise PlainFormError("needs header, records, ticks and complete")
    header = header_from_plain(meta["header"])
    if not isinstance(meta["records"], list):
        raise PlainFormError("records: needs a list")
    records = [record_from_plain(record) for record in meta["records"]]
    for record, behind in pairwise(records):
        if behind.tick < record.tick:
            raise PlainFormError(f"records: tick {behind.tick} follows tick {record.tick}")
    if type(meta["complete"]) is not bool:
        raise PlainFormError("complete: needs true or false")
    return header, records, _runs(meta["ticks"]), meta["complete"]


def _runs(plain: object) -> Integers:
    pairs = plain if isinstance(plain, list) else [None]
    if not all(isinstance(pair, list) and [type(count) for count in pair] == [int, int] for pair in pairs):
        raise PlainFormError("ticks: needs pairs of counts")
    try:
        return np.array(pairs, dtype=np.int64).reshape(-1, 2)
    except OverflowError as cause:
        raise PlainFormError("ticks: a count is too large") from cause


def _member(archive: zipfile.ZipFile, key: str) -> Any:
    """One small array; the whole member is read first, so that its checksum is compared before all else."""
    info = archive.getinfo(f"{key}.npy")
    if info.file_size > _LONGEST_MEMBER:
        raise ValueError(f"{key} has more than {_LONGEST_MEMBER:,} bytes")
    data = io.BytesIO(archive.read(info))
    return np.lib.format.read_array(data, allow_pickle=False)


class _Ticks:
    """Ticks of all rows, from runs [first, count] (R, 2) that have no gap inside."""

    def __init__(self, runs: Integers, rows: int) -> None:
        # Python adds without bound, where counts of a damaged file could overflow.
        if (runs < 0).any() or sum(runs[:, 1].tolist()) != rows:
            raise PlainFormError(f"ticks: {rows} rows are there, another number is said")
        self.rows = rows
        self._firsts = runs[:, 0]
        self._ends = np.cumsum(runs[:, 1])
        self._begins = self._ends - runs[:, 1]

    def part(self, start: int, stop: int) -> Integers:
        """Ticks of the rows from `start` to before `stop`."""
        rows = np.arange(start, stop, dtype=np.int64)
        run = np.searchsorted(self._ends, rows, side="right")
        return self._firsts[run] + (rows - self._begins[run])


class _Array:
    """One array of an archive, read from its first row on; `rows` is what its own head says."""

    def __init__(self, key: str, handle: IO[bytes]) -> None:
        self._key = key
        self._handle = handle
        self._shape, self._kind, self._by_columns = _array_head(key, handle)
        self.rows = self._shape[0] if self._shape else 0
        self._whole: Any = None
        self._done = 0

    def check(self, shape: tuple[int, ...], kind: type[np.generic]) -> None:
        """Raises ValueError unless the array has this shape and type."""
        if self._shape != shape or self._kind != kind:
            found = f"{self._shape} {self._kind}"
            raise ValueError(f"{self._key} needs shape {shape} and {kind.__name__}, found {found}")

    def take(self, rows: int) -> Any:
        """The next rows; raises ValueError where the data end before."""
        start, self._done = self._done, self._done + rows
        if not self._by_columns:
            return self._read((rows, *self._shape[1:]))
        # Column after column, as numpy stores some arrays that others made: rows cannot be cut out.
        if self._whole is None:
            self._whole = self._read(self._shape[::-1]).T
        return self._whole[start : self._done].copy()

    def finish(self) -> None:
        """Read on to the member's end, where its checksum is compared."""
        while self._handle.read(_REST):
            pass

    def _read(self, shape: tuple[int, ...]) -> Any:
        wanted = prod(shape) * self._kind.itemsize
        data = self._handle.read(wanted) if wanted else b""
        if len(data) < wanted:
            raise ValueError(f"{self._key} ends early")
        return np.ndarray(shape, self._kind, data)


def _array_head(key: str, handle: IO[bytes]) -> tuple[tuple[int, ...], np.dtype[Any], bool]:
    """Shape and type of the array that begins here, and whether it goes column after column.

    Its checksum comes much later, so that the text is taken as numpy writes it for plain numbers or not at
    all: numpy's own reader guesses what damaged text may mean.
    """
    version, _ = np.lib.format.read_magic(handle)
    length = int.from_bytes(handle.read(2 if version == 1 else 4), "little")
    head = _HEAD.fullmatch(handle.read(min(length, _LONGEST_HEAD)))
    if head is None:
        raise ValueError(f"{key} is no array of numbers")
    shape = tuple(int(word) for word in head["shape"].split(b",") if word.strip())
    try:
        return shape, np.dtype(head["kind"].decode()), head["columns"] == b"True"
    except TypeError as cause:
        raise ValueError(f"{key} is no array of numbers") from cause
