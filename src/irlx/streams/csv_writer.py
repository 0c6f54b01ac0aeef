"""CSV: provenance in comment lines, one line of column names, one line a tick, and a closing comment.

Carries the samples and the header, not the blocks. Strings and lists in comments are JSON.
"""

from __future__ import annotations

import csv
import io
import json
import os
from typing import Any

import numpy as np

from irlx.streams.header_plain import header_to_plain
from irlx.streams.joint_stream import BlockRecord, StreamHeader
from irlx.streams.numbers import rows_of, texts_of, texts_of_rows
from irlx.streams.scan import RowBatch, StatedRates
from irlx.streams.text_writer import TextWriter

_TOOL = ("x", "y", "z", "qx", "qy", "qz", "qw")


class CsvWriter(TextWriter):
    """Writes the samples of one stream as CSV, UTF-8, numbers so that they read back to the same bits.

    Columns: tick, t (s), block id, q, qd and qdd of every joint (rad or m, per s, per s2), tool pose. See
    `StreamWriter`.
    """

    def __init__(self, path: str | os.PathLike[str], header: StreamHeader) -> None:
        super().__init__(path, header)
        self._write(_head(header))

    def _put_block(self, record: BlockRecord) -> None:
        """CSV has no blocks."""

    def _put_rows(self, batch: RowBatch) -> None:
        self._write(_lines(batch, self._rates_of(batch)))

    def _put_end(self, complete: bool) -> None:
        end = {"samples": self.rows, "complete": complete, "sha256": self._digest.hexdigest()}
        self._write(comment("end", end))


def comment(key: str, value: Any) -> bytes:
    """Comment line of one entry of a header, or of the end; the value as JSON."""
    return f"# {key}: {json.dumps(value)}\n".encode()


def _head(header: StreamHeader) -> bytes:
    lines = [comment(key, value) for key, value in header_to_plain(header).items()]
    return b"".join([*lines, column_line(header)])


def column_names(header: StreamHeader) -> list[str]:
    """Names of the columns; line breaks and other control characters in joint names become blanks."""
    names = ["".join(c if c.isprintable() else " " for c in name) for name in header.joint_names]
    joints = [f"{prefix}_{name}" for prefix in ("q", "qd", "qdd") for name in names]
    return ["tick", "t", "block", *joints, *(f"tool_{part}" for part in _TOOL)]


def column_line(header: StreamHeader) -> bytes:
    """Line with the names of the columns; the comment lines have the names of joints as they are."""
    line = io.StringIO()
    csv.writer(line, lineterminator="\n").writerow(column_names(header))
    return line.getvalue().encode("utf-8", "backslashreplace")


def _lines(batch: RowBatch, rates: StatedRates) -> bytes:
    """Lines of rows, numbers with as few digits as they take."""
    tails = texts_of_rows(np.concatenate((batch.q, rates.qd, rates.qdd, batch.tool), axis=1))
    ticks, block = texts_of(batch.ticks), texts_of(batch.block)
    return rows_of(ticks, b",", texts_of(rates.t), b",", block, b",", tails, b"\n")
