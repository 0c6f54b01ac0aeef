"""Strict reader of the Parquet files that `ParquetWriter` writes, some rows at a time."""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import IO, Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from irlx.diagnostics import Place, report
from irlx.streams.error import StreamError, broken, open_to_read
from irlx.streams.header_plain import PlainFormError, VersionError, header_from_plain, record_from_plain
from irlx.streams.joint_stream import FORMAT_VERSION, BlockRecord, Integers, StreamHeader
from irlx.streams.parquet.table import END, HEADER, RECORDS, Digest, rows_of, schema_of
from irlx.streams.scan import ScanItem, StreamEnd, rising_rows

_PORTION = 4096
_BUFFER = 1 << 16
_DAMAGE = (pa.ArrowException, ValueError, KeyError, IndexError, OverflowError, RecursionError, MemoryError)


def scan(path: Path) -> Iterator[ScanItem]:
    """Scan of a Parquet file that `ParquetWriter` wrote: all block records, then the rows in portions.

    Raises StreamError once the rows before the damage are out: IRL001, IRL002, IRL007 where the file
    cannot be read, IRL701 where it is damaged, IRL702 for a wrong checksum, IRL703 for ticks that do not
    rise, IRL704 for another number of rows, IRL706 for another version.
    """
    with open_to_read(path) as handle:
        try:
            yield from _items(path, handle)
        except VersionError as cause:
            raise StreamError(
                report("IRL706", Place(str(path)), found=cause.found, known=FORMAT_VERSION)
            ) from cause
        except PlainFormError as cause:
            raise broken(path, "Parquet", str(cause), "metadata") from cause
        except _DAMAGE as cause:
            raise _damaged(path, cause) from cause
        except OSError as cause:
            # pyarrow raises it for files that it cannot take, without a number of the system's.
            if cause.errno is not None:
                raise
            raise _damaged(path, cause) from cause


def _items(path: Path, handle: IO[bytes]) -> Iterator[ScanItem]:
    # Not buffered ahead: that takes whole row groups into memory.
    options = {"buffer_size": _BUFFER, "pre_buffer": False, "page_checksum_verification": True}
    with pq.ParquetFile(handle, **options) as file:
        texts = _texts(file)
        header = header_from_plain(json.loads(texts[HEADER]))
        records = _records(texts[RECORDS])
        samples, complete, said = _end(texts[END])
        _check_columns(file, header)
        found = file.metadata.num_rows
        if found != samples:
            where = Place(str(path))
            raise StreamError(report("IRL704", where, said=samples, what="samples", found=found))
        yield header
        yield from records
        digest = Digest()
        yield from _rows(path, file, header, digest)
        expected = digest.end(texts[HEADER], texts[RECORDS], samples, complete)
        if said != expected:
            raise StreamError(report("IRL702", Place(str(path)), found=said[:12], expected=expected[:12]))
        yield StreamEnd(complete)


def _rows(path: Path, file: Any, header: StreamHeader, digest: Digest) -> Iterator[ScanItem]:
    last = -1
    for columns in file.iter_batches(batch_size=_PORTION, use_threads=False):
        bits = _bits(columns)
        digest.rows(bits)
        batch = rows_of(bits, header.joints)
        rows = rising_rows(batch.ticks, last)
        good = np.asarray(np.isfinite(batch.q).all(axis=1) & np.isfinite(batch.tool).all(axis=1))
        whole = rows if good[:rows].all() else int(np.argmin(good[:rows]))
        if whole:
            last = int(batch.ticks[whole - 1])
            yield batch.part(slice(0, whole))
        if whole < rows:
            raise broken(path, "Parquet", "joint values and tool poses are finite", f"row of tick {last + 1}")
        if rows < len(batch.ticks):
            tick = int(batch.ticks[rows])
            raise StreamError(report("IRL703", Place(str(path)), tick=tick, previous=last))


def _bits(columns: Any) -> Integers:
    """Values (N, columns) of a record batch, each as the integer that has its 64 bits."""
    arrays = [column.to_numpy(zero_copy_only=True) for column in columns.columns]
    return np.stack([array.view(np.int64) for array in arrays], axis=1)


def _texts(file: Any) -> dict[bytes, bytes]:
    """The three JSON texts of the file's metadata."""
    found = file.metadata.metadata or {}
    for key in (HEADER, RECORDS, END):
        if key not in found:
            raise PlainFormError(f"{key.decode()} is missing: irlx did not write this file")
    return dict(found)


def _records(text: bytes) -> list[BlockRecord]:
    plain = json.loads(text)
    if not isinstance(plain, list):
        raise PlainFormError("records: needs a list")
    records = [record_from_plain(record) for record in plain]
    for record, behind in pairwise(records):
        if behind.tick < record.tick:
            raise PlainFormError(f"records: tick {behind.tick} follows tick {record.tick}")
    return records


def _end(text: bytes) -> tuple[int, bool, str]:
    """Number of samples, complete flag and checksum."""
    end = json.loads(text)
    kinds = {"samples": int, "complete": bool, "sha256": str}
    if not isinstance(end, dict) or {key: type(value) for key, value in end.items()} != kinds:
        raise PlainFormError("irlx.end has samples, complete and sha256")
    return end["samples"], end["complete"], end["sha256"]


def _check_columns(file: Any, header: StreamHeader) -> None:
    found = [(field.name, field.type) for field in file.schema_arrow]
    if found != [(field.name, field.type) for field in schema_of(header)]:
        raise PlainFormError("the columns do not fit the header")


def _damaged(path: Path, cause: BaseException) -> StreamError:
    words = " ".join(str(cause).split())
    return broken(path, "Parquet", f"it is damaged ({words[:200]})")
