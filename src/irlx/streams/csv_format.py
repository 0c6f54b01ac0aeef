"""CSV: provenance in comment lines, one line of column names, one line a tick, and a closing comment.

Carries the samples and the header, not the blocks. Strings and lists in comments are JSON.
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
import os
from collections.abc import Iterator
from itertools import chain
from typing import Any

import numpy as np

from irlx.diagnostics import Place, report
from irlx.streams.atomic import AtomicFile
from irlx.streams.error import StreamError
from irlx.streams.header_plain import header_to_plain
from irlx.streams.irdata.digits import FIELD, fill_fields
from irlx.streams.joint_stream import JointStream, StreamHeader

_ROWS = 1024
_TOOL = ("x", "y", "z", "qx", "qy", "qz", "qw")


def write_csv(stream: JointStream, path: str | os.PathLike[str]) -> None:
    """Write a stream as CSV, UTF-8, numbers so that they read back to the same bits.

    Columns: tick, t (s), block id, q, qd and qdd of every joint (rad or m, per s, per s2), tool pose.
    Raises StreamError IRL003 where the file cannot be written, IRL708 for values that are not finite.
    """
    if not (np.isfinite(stream.q).all() and np.isfinite(stream.tool).all()):
        raise StreamError(report("IRL708", Place(str(path)), reason="a sample is not finite"))
    digest = hashlib.sha256()
    with AtomicFile(path) as file:
        for data in chain([_head(stream.header)], _rows(stream)):
            digest.update(data)
            file.write(data)
        end = {"samples": len(stream.ticks), "complete": stream.complete, "sha256": digest.hexdigest()}
        file.write(comment("end", end))


def comment(key: str, value: Any) -> bytes:
    """Comment line of one entry of a header, or of the end; the value as JSON."""
    return f"# {key}: {json.dumps(value)}\n".encode()


def _head(header: StreamHeader) -> bytes:
    lines = [comment(key, value) for key, value in header_to_plain(header).items()]
    return b"".join([*lines, column_line(header)])


def column_line(header: StreamHeader) -> bytes:
    """Names of the columns; line breaks and other control characters in joint names become blanks.

    The comment lines have the names as they are.
    """
    names = ["".join(c if c.isprintable() else " " for c in name) for name in header.joint_names]
    joints = [f"{prefix}_{name}" for prefix in ("q", "qd", "qdd") for name in names]
    line = io.StringIO()
    columns = ["tick", "t", "block", *joints, *(f"tool_{part}" for part in _TOOL)]
    csv.writer(line, lineterminator="\n").writerow(columns)
    return line.getvalue().encode("utf-8", "backslashreplace")


def _rows(stream: JointStream) -> Iterator[bytes]:
    """Lines of the samples, many rows at a time; numbers with 17 digits, as in IRDATA-like records."""
    for start in range(0, len(stream.ticks), _ROWS):
        part = slice(start, start + _ROWS)
        tables = (stream.q[part], stream.qd[part], stream.qdd[part], stream.tool[part])
        values = np.concatenate(tables, axis=1)
        lines = np.empty(len(values), dtype=[("numbers", FIELD, (values.shape[1],)), ("end", "S1")])
        fill_fields(lines["numbers"], values)
        lines["end"] = b"\n"
        tails = lines.view(f"S{lines.dtype.itemsize}").tolist()
        columns = (stream.ticks[part].tolist(), stream.t[part].tolist(), stream.block[part].tolist(), tails)
        heads = zip(*columns, strict=True)
        # The fields are padded to one width, which a CSV has no use for.
        yield b"".join([b"%d,%a,%d%b" % head for head in heads]).translate(None, b" ")
