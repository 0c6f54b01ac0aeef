"""JSON Lines: an object a line, first the header, then records of blocks and samples, at last the end."""

from __future__ import annotations

import json
import os
from typing import Any

import numpy as np

from irlx.streams.header_plain import header_to_plain, record_to_plain
from irlx.streams.irdata.digits import FIELD, fill_fields
from irlx.streams.joint_stream import BlockRecord, Floats, StreamHeader
from irlx.streams.rates import Rates
from irlx.streams.scan import RowBatch, StatedRates
from irlx.streams.text_writer import TextWriter

SAMPLE_KEYS = ("tick", "t", "block", "q", "qd", "qdd", "tool")
"""Entries of a sample, in the order of the file."""


class JsonlWriter(TextWriter):
    """Writes one stream as JSON Lines, UTF-8, numbers so that they read back to the same bits.

    See `StreamWriter`.
    """

    def __init__(self, path: str | os.PathLike[str], header: StreamHeader) -> None:
        super().__init__(path, header)
        self._rates = Rates(header)
        self._write(line_of("header", header_to_plain(header)))

    def _put_block(self, record: BlockRecord) -> None:
        self._write(line_of("record", record_to_plain(record)))

    def _put_rows(self, batch: RowBatch) -> None:
        self._write(_lines(batch, self._rates.of(batch.ticks, batch.q)))

    def _put_end(self, complete: bool) -> None:
        end = {"samples": self.rows, "complete": complete, "sha256": self._digest.hexdigest()}
        self._write(line_of("end", end))


def line_of(key: str, value: Any) -> bytes:
    """Line of an object with one entry."""
    return json.dumps({key: value}, allow_nan=False).encode() + b"\n"


def _lines(batch: RowBatch, rates: StatedRates) -> bytes:
    """Lines of samples, numbers with 17 digits, as in IRDATA-like records."""
    vectors: dict[str, Floats] = {"q": batch.q, "qd": rates.qd, "qdd": rates.qdd, "tool": batch.tool}
    kinds: list[Any] = []
    for key, values in vectors.items():
        kinds += [(f"{key} begins", "S9"), (key, FIELD, (values.shape[1],)), (f"{key} ends", "S1")]
    table = np.empty(len(batch.ticks), dtype=[*kinds, ("end", "S2")])
    for key, values in vectors.items():
        table[f"{key} begins"], table[f"{key} ends"] = f',"{key}":['.encode(), b"]"
        fill_fields(table[key], values)
    table["end"] = b"}\n"
    tails = table.view(f"S{table.dtype.itemsize}").tolist()
    heads = zip(batch.ticks.tolist(), rates.t.tolist(), batch.block.tolist(), tails, strict=True)
    text = b"".join([b'{"tick":%d,"t":%a,"block":%d%b' % head for head in heads])
    # Fields are padded to one width and begin with a comma, the first of a list as well.
    return text.translate(None, b" \0").replace(b"[,", b"[")
