"""Joint samples (code 900) <-> text, many rows at a time."""

from __future__ import annotations

from itertools import count
from typing import NamedTuple

import numpy as np

from irlx.streams.irdata.codes import SAMPLE
from irlx.streams.irdata.digits import FIELD, fill_fields
from irlx.streams.irdata.record import LINE_END, RecordError
from irlx.streams.joint_stream import Floats, Integers

MARK = f", {SAMPLE}, ".encode()
"""What makes a line a sample: no other record has this after its number."""

_INTEGER_COLUMNS = 4
_ALLOWED = b"0123456789+-.e, "
_LARGEST = 2**53
_END = LINE_END


class SampleBatch(NamedTuple):
    """Consecutive rows: ticks (N,), q (N, n), block (N,), tool (N, 7)."""

    ticks: Integers
    q: Floats
    block: Integers
    tool: Floats


def samples_text(first: int, batch: SampleBatch) -> bytes:
    """Lines of the rows of a batch, numbered from `first`: tick, block id, joint values, tool pose."""
    values = np.concatenate([batch.q, batch.tool], axis=1)
    table = np.empty(
        len(values), dtype=[("numbers", FIELD, (values.shape[1],)), ("end", f"S{len(LINE_END)}")]
    )
    fill_fields(table["numbers"], values)
    table["end"] = LINE_END
    tails = table.view(f"S{table.dtype.itemsize}").tolist()
    heads = zip(count(first), batch.ticks.tolist(), batch.block.tolist(), tails, strict=False)
    return b"".join([b"%d, 900, %d, %d%b" % head for head in heads])


def parse_samples(lines: list[bytes], first: int, joints: int) -> SampleBatch:
    """Batch of sample lines that must be numbered from `first`; raises RecordError.

    The message does not say which line is wrong: parse them one by one to find out.
    """
    columns = _INTEGER_COLUMNS + joints + 7
    for line in lines:
        if line.count(b", ") != columns - 1 or not line.endswith((b" ;\n", b" ;")):
            raise RecordError(f"a sample of {joints} joints has {columns} fields and ends with ' ;'")
    text = b", ".join([line.rstrip(_END) for line in lines])
    if text.translate(None, _ALLOWED):
        raise RecordError("a sample holds numbers only")
    try:
        table = np.array(list(map(float, text.split(b", ")))).reshape(len(lines), columns)
    except ValueError as cause:
        raise RecordError("a sample holds numbers only") from cause
    heads, values = table[:, :_INTEGER_COLUMNS], table[:, _INTEGER_COLUMNS:]
    if not np.isfinite(values).all():
        raise RecordError("a value is not finite")
    if not ((heads >= 0) & (heads < _LARGEST) & (heads == np.floor(heads))).all():
        raise RecordError("record number, code, tick and block id are counts")
    whole = heads.astype(np.int64)
    if not np.array_equal(whole[:, 0], np.arange(first, first + len(lines))):
        raise RecordError(f"record number {first} is due here")
    return SampleBatch(whole[:, 2], values[:, :joints].copy(), whole[:, 3], values[:, joints:].copy())
