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
from pathlib import Path
from typing import Any

import numpy as np

from irlx.diagnostics import Place, report
from irlx.streams.atomic import AtomicFile
from irlx.streams.error import StreamError, broken, open_to_read
from irlx.streams.header_plain import PlainFormError, VersionError, header_from_plain, header_to_plain
from irlx.streams.irdata.digits import FIELD, fill_fields
from irlx.streams.joint_stream import FORMAT_VERSION, JointStream, StreamHeader

_ROWS = 1024
_ALLOWED = b"0123456789+-.e,\n"
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
        file.write(_comment("end", end))


def _comment(key: str, value: Any) -> bytes:
    return f"# {key}: {json.dumps(value)}\n".encode()


def _head(header: StreamHeader) -> bytes:
    lines = [_comment(key, value) for key, value in header_to_plain(header).items()]
    return b"".join([*lines, _column_line(header)])


def _column_line(header: StreamHeader) -> bytes:
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


def read_csv(path: str | os.PathLike[str]) -> JointStream:
    """Stream of a CSV file that `write_csv` wrote: header and samples, without blocks.

    A file without its closing comment was cut: it is read up to its last whole line, `complete`
    being False. Raises StreamError with the codes of `read_irdata`.
    """
    path = Path(path)
    with open_to_read(path) as handle:
        lines = handle.read().splitlines(keepends=True)
    if lines and not lines[-1].endswith(b"\n"):
        rest = lines.pop()
        if rest.startswith(_comment("end", {})[:-3]) and b"}" in rest:
            raise broken(path, "CSV", "the closing comment does not end its line", f"line {len(lines) + 1}")
    count = next((row for row, line in enumerate(lines) if not line.startswith(b"# ")), None)
    if count is None:
        raise StreamError(report("IRL705", Place(str(path))))
    header = _read_head(path, lines[:count])
    if lines[count] != _column_line(header):
        raise broken(path, "CSV", "the names of the columns do not fit the header", f"line {count + 1}")
    body, complete = _split_end(path, lines, count + 1)
    return _stream(path, header, body, complete, count + 2)


def _read_head(path: Path, lines: list[bytes]) -> StreamHeader:
    plain: dict[str, Any] = {}
    for number, line in enumerate(lines, 1):
        try:
            key, separator, value = line.decode()[2:].partition(": ")
            if not separator or key in plain:
                raise ValueError("a comment is '# key: value', each key once")
            plain[key] = json.loads(value)
        except ValueError as cause:
            raise broken(path, "CSV", str(cause), f"line {number}") from cause
    try:
        return header_from_plain(plain)
    except VersionError as cause:
        raise StreamError(
            report("IRL706", Place(str(path)), found=cause.found, known=FORMAT_VERSION)
        ) from cause
    except PlainFormError as cause:
        raise broken(path, "CSV", str(cause), "header") from cause


def _split_end(path: Path, lines: list[bytes], start: int) -> tuple[list[bytes], bool]:
    """Lines of samples, and what the closing comment says about completeness; checks its sums."""
    body = lines[start:]
    if not body or not body[-1].startswith(b"#"):
        return body, False
    last = body.pop()
    try:
        end = json.loads(last.removeprefix(b"# end: "))
        wanted = (int(end["samples"]), bool(end["complete"]), str(end["sha256"]))
        if last != _comment("end", dict(zip(("samples", "complete", "sha256"), wanted, strict=True))):
            raise ValueError("it has another form")
    except (ValueError, KeyError, TypeError) as cause:
        raise broken(path, "CSV", "the closing comment is damaged", f"line {len(lines)}") from cause
    expected = hashlib.sha256(b"".join(lines[:-1])).hexdigest()
    if wanted[2] != expected:
        raise StreamError(report("IRL702", Place(str(path)), found=wanted[2][:12], expected=expected[:12]))
    if wanted[0] != len(body):
        raise StreamError(report("IRL704", Place(str(path)), said=wanted[0], what="samples", found=len(body)))
    return body, wanted[1]


def _stream(path: Path, header: StreamHeader, body: list[bytes], complete: bool, first: int) -> JointStream:
    joints = header.joints
    columns = 3 + 3 * joints + 7
    rows: list[list[float]] = []
    for number, line in enumerate(body, first):
        words = line.split(b",")
        try:
            if len(words) != columns or line.translate(None, _ALLOWED):
                raise ValueError
            rows.append([float(word) for word in words])
        except ValueError as cause:
            raise broken(path, "CSV", f"a line of samples has {columns} numbers", f"line {number}") from cause
    table = np.array(rows).reshape(len(rows), columns)
    heads = table[:, [0, 2]]
    finite = np.isfinite(table).all()
    if not finite or not ((heads >= 0) & (heads < 2**53) & (heads == np.floor(heads))).all():
        raise broken(path, "CSV", "ticks and block ids are counts, all values finite")
    ticks, block = heads.astype(np.int64).T.copy()
    check_rising(path, ticks)
    q, tool = table[:, 3 : 3 + joints].copy(), table[:, -7:].copy()
    return JointStream(header, (), ticks, q, block, tool, complete)


def check_rising(path: Path, ticks: np.ndarray[Any, np.dtype[np.int64]]) -> None:
    """Raises StreamError IRL703 unless ticks (N,) rise strictly."""
    falls = np.diff(ticks) <= 0
    if falls.any():
        row = int(np.argmax(falls))
        tick, previous = int(ticks[row + 1]), int(ticks[row])
        raise StreamError(report("IRL703", Place(str(path)), tick=tick, previous=previous))
