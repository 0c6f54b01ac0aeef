"""JSON Lines: an object a line, first the header, then records of blocks and samples, at last the end."""

from __future__ import annotations

import json
import os
from typing import Any

from irlx.streams.header_plain import header_to_plain, record_to_plain
from irlx.streams.joint_stream import BlockRecord, StreamHeader
from irlx.streams.numbers import rows_of, texts_of, texts_of_rows
from irlx.streams.scan import RowBatch, StatedRates
from irlx.streams.text_writer import TextWriter

SAMPLE_KEYS = ("tick", "t", "block", "q", "qd", "qdd", "tool")
"""Entries of a sample, in the order of the file."""

_SAMPLE = (b'{"tick":', b',"t":', b',"block":', b',"q":[', b'],"qd":[', b'],"qdd":[', b'],"tool":[')
"""What stands before each of them."""


class JsonlWriter(TextWriter):
    """Writes one stream as JSON Lines, UTF-8, numbers so that they read back to the same bits.

    See `StreamWriter`.
    """

    def __init__(self, path: str | os.PathLike[str], header: StreamHeader) -> None:
        super().__init__(path, header)
        self._write(line_of("header", header_to_plain(header)))

    def _put_block(self, record: BlockRecord) -> None:
        self._write(line_of("record", record_to_plain(record)))

    def _put_rows(self, batch: RowBatch) -> None:
        self._write(_lines(batch, self._rates_of(batch)))

    def _put_end(self, complete: bool) -> None:
        end = {"samples": self.rows, "complete": complete, "sha256": self._digest.hexdigest()}
        self._write(line_of("end", end))


def line_of(key: str, value: Any) -> bytes:
    """Line of an object with one entry."""
    return json.dumps({key: value}, allow_nan=False).encode() + b"\n"


def _lines(batch: RowBatch, rates: StatedRates) -> bytes:
    """Lines of samples, numbers with as few digits as they take."""
    counts = (texts_of(batch.ticks), texts_of(rates.t), texts_of(batch.block))
    vectors = (texts_of_rows(values) for values in (batch.q, rates.qd, rates.qdd, batch.tool))
    parts = zip(_SAMPLE, [*counts, *vectors], strict=True)
    return rows_of(*(part for pair in parts for part in pair), b"]}\n")
