"""Rows as Parquet has them: one column a value, and one digest over all of them."""

from __future__ import annotations

import hashlib
import json
from typing import Any

import numpy as np
import pyarrow as pa

from irlx.streams.csv_writer import column_names
from irlx.streams.joint_stream import Integers, StreamHeader
from irlx.streams.scan import RowBatch, StatedRates

HEADER, RECORDS, END = b"irlx.header", b"irlx.records", b"irlx.end"
"""Keys of the file's metadata; their values are JSON."""

_COUNTS = (0, 2)


def schema_of(header: StreamHeader) -> Any:
    """Columns of a stream's file, none of them with gaps: those of CSV, every name there once."""
    names: list[str] = []
    for name in column_names(header):
        free = name.encode("utf-8", "backslashreplace").decode()
        while free in names:
            free += "_"
        names.append(free)
    kinds = [pa.int64() if column in _COUNTS else pa.float64() for column in range(len(names))]
    return pa.schema([pa.field(*pair, nullable=False) for pair in zip(names, kinds, strict=True)])


def bits_of(batch: RowBatch, rates: StatedRates) -> Integers:
    """All values of N rows in the order of the columns, each as the integer that has its 64 bits."""
    floats = rates.t[:, None], batch.q, rates.qd, rates.qdd, batch.tool
    t, *rest = (np.ascontiguousarray(part, "<f8").view("<i8") for part in floats)
    return np.concatenate([batch.ticks[:, None], t, batch.block[:, None], *rest], axis=1)


def rows_of(bits: Integers, joints: int) -> RowBatch:
    """What `bits_of` was made of."""
    ticks, block = (np.ascontiguousarray(bits[:, column]) for column in _COUNTS)
    floats = np.ascontiguousarray(np.delete(bits, _COUNTS, axis=1)).view(np.float64)
    splits = np.cumsum([1, joints, joints, joints])
    t, q, qd, qdd, tool = (part.copy() for part in np.split(floats, splits, axis=1))
    return RowBatch(ticks, q, block, tool, StatedRates(t[:, 0], qd, qdd))


def table_of(bits: Integers, schema: Any) -> Any:
    """Table of pyarrow of rows that `bits_of` gave."""
    columns = [np.ascontiguousarray(bits[:, column]) for column in range(bits.shape[1])]
    kinds = [np.int64 if column in _COUNTS else np.float64 for column in range(bits.shape[1])]
    arrays = [pa.array(column.view(kind)) for column, kind in zip(columns, kinds, strict=True)]
    return pa.Table.from_arrays(arrays, schema=schema)


class Digest:
    """SHA-256 over the values of a stream, however a file packs them."""

    def __init__(self) -> None:
        self._sum = hashlib.sha256()

    def rows(self, bits: Integers) -> None:
        """Count rows in, one after the other."""
        self._sum.update(np.ascontiguousarray(bits, "<i8").data)

    def end(self, header: bytes, records: bytes, samples: int, complete: bool) -> str:
        """Count texts of header and records and the end in; gives the sum in hexadecimal digits."""
        for part in (header, records, json.dumps([samples, complete]).encode()):
            self._sum.update(part)
        return self._sum.hexdigest()
