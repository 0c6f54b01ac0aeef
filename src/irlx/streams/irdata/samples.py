"""Joint samples (code 900) <-> text, many rows at a time."""

from __future__ import annotations

import numpy as np

from irlx.streams.irdata.codes import SAMPLE
from irlx.streams.irdata.record import LINE_END, RecordError
from irlx.streams.joint_stream import Floats, Integers
from irlx.streams.numbers import NUMBER_CHARACTERS, rows_of, table_of, texts_of, texts_of_rows
from irlx.streams.scan import RowBatch

MARK = f", {SAMPLE}, ".encode()
"""What makes a line a sample: no other record has this after its number."""

_INTEGER_COLUMNS = 4
_ALLOWED = NUMBER_CHARACTERS + b" "
_LARGEST = 2**53
_LONGEST_NUMBER = 24
# Few lines are read sooner one by one than by operations on arrays.
_MANY = 32


def is_sample(line: bytes) -> bool:
    """Whether a line is that of a sample."""
    return line.startswith(MARK, line.find(b",", 1, _LONGEST_NUMBER))


def samples_text(first: int, batch: RowBatch) -> bytes:
    """Lines of the rows of a batch, numbered from `first`: tick, block id, joint values, tool pose."""
    tails = texts_of_rows(np.concatenate([batch.q, batch.tool], axis=1), b", ")
    numbers = texts_of(np.arange(first, first + len(batch.ticks)))
    ticks, block = texts_of(batch.ticks), texts_of(batch.block)
    return rows_of(numbers, MARK, ticks, b", ", block, b", ", tails, LINE_END)


def parse_samples(lines: list[bytes], first: int, joints: int) -> RowBatch:
    """Batch of sample lines that must be numbered from `first`; raises RecordError.

    The message does not say which line is wrong: parse them one by one to find out.
    """
    columns = _INTEGER_COLUMNS + joints + 7
    heads, values = _numbers(lines, columns)
    if not np.isfinite(values).all():
        raise RecordError("a value is not finite")
    if not np.array_equal(heads[:, 0], np.arange(first, first + len(lines))):
        raise RecordError(f"record number {first} is due here")
    q, tool = values[:, :joints].copy(), values[:, joints:].copy()
    return RowBatch(heads[:, 2].copy(), q, heads[:, 3].copy(), tool)


def _numbers(lines: list[bytes], columns: int) -> tuple[Integers, Floats]:
    """The counts (N, 4) at the beginning of each line and the values behind them; raises RecordError."""
    if len(lines) >= _MANY:
        try:
            return _many_numbers(lines, columns)
        except ValueError:
            # The reading line by line allows more forms of numbers, and has the words for what is wrong.
            pass
    return _few_numbers(lines, columns)


def _many_numbers(lines: list[bytes], columns: int) -> tuple[Integers, Floats]:
    """Numbers of lines as `samples_text` makes them; raises ValueError for others."""
    text = b"".join(lines)
    if not text.endswith(b"\n"):
        text += b"\n"
    ends = {text.count(end) for end in (LINE_END, b";", b"\n")}
    if ends != {len(lines)} or text.count(b",") != text.count(b", "):
        raise ValueError("a line has another form")
    table = table_of(text.replace(LINE_END, b"\n"), columns)
    heads = table[:, :_INTEGER_COLUMNS]
    if not ((heads >= 0) & (heads < _LARGEST) & (heads == np.floor(heads))).all():
        raise ValueError("a count is none")
    return heads.astype(np.int64), table[:, _INTEGER_COLUMNS:]


def _few_numbers(lines: list[bytes], columns: int) -> tuple[Integers, Floats]:
    for line in lines:
        if line.count(b", ") != columns - 1 or not line.endswith((b" ;\n", b" ;")):
            joints = columns - _INTEGER_COLUMNS - 7
            raise RecordError(f"a sample of {joints} joints has {columns} fields and ends with ' ;'")
    text = b", ".join([line.removesuffix(b"\n").removesuffix(b" ;") for line in lines])
    if text.translate(None, _ALLOWED + b","):
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
    return heads.astype(np.int64), values
