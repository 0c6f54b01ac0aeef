"""Float64 <-> decimal text, whole arrays at a time, to the same 64 bits.

Numbers are written with as few digits as read back to the same value, and read to the nearest: by orjson.
"""

from __future__ import annotations

import numpy as np
import orjson

from irlx.streams.joint_stream import Floats, Integers

NUMBER_CHARACTERS = b"0123456789+-.e"
"""All that a number is made of."""


def texts_of_rows(values: Floats, between: bytes = b",") -> list[bytes]:
    """Text of each row of finite values (N, n), `between` its numbers; each has a point or an exponent."""
    if not len(values):
        return []
    text = orjson.dumps(np.ascontiguousarray(values), option=orjson.OPT_SERIALIZE_NUMPY)
    if between != b",":
        text = text.replace(b",", between)
    return text[2:-2].split(b"]" + between + b"[")


def texts_of(values: Floats | Integers) -> list[bytes]:
    """Text of each of finite values or counts (N,)."""
    if not len(values):
        return []
    text = orjson.dumps(np.ascontiguousarray(values), option=orjson.OPT_SERIALIZE_NUMPY)
    return text[1:-1].split(b",")


def rows_of(*columns: bytes | list[bytes]) -> bytes:
    """The texts of rows one after another, each made of `columns`: one text a row, or the same for all.

    At least one column is a list; to copy every text but once is what takes the time of long streams.
    """
    count = next(len(column) for column in columns if isinstance(column, list))
    texts = [b""] * (len(columns) * count)
    for place, column in enumerate(columns):
        texts[place :: len(columns)] = column if isinstance(column, list) else [column] * count
    return b"".join(texts)


def table_of(text: bytes, columns: int) -> Floats:
    """Values (N, columns) of lines, each ended by a line feed: numbers with commas between, blanks allowed.

    Raises ValueError for whatever else.
    """
    if text.translate(None, NUMBER_CHARACTERS + b", \n"):
        raise ValueError("there are other characters than those of numbers")
    rows = orjson.loads(b"[[" + text.removesuffix(b"\n").replace(b"\n", b"],[") + b"]]")
    table = np.array(rows, dtype=np.float64)
    if table.shape[1:] != (columns,):
        raise ValueError("a line has another number of fields")
    return table
