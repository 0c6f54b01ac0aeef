"""NPZ: the arrays of a stream for numpy, with everything else as JSON text under `meta`."""

from __future__ import annotations

import errno
import io
import json
import os
import zipfile
import zlib
from pathlib import Path
from typing import IO, Any

import numpy as np

from irlx.diagnostics import Place, report
from irlx.streams.atomic import AtomicFile
from irlx.streams.csv_format import check_rising
from irlx.streams.error import StreamError, broken, open_to_read
from irlx.streams.header_plain import (
    PlainFormError,
    VersionError,
    header_from_plain,
    header_to_plain,
    record_from_plain,
    record_to_plain,
)
from irlx.streams.joint_stream import FORMAT_VERSION, Integers, JointStream

KEYS = ("t", "q", "qd", "qdd", "tool", "block", "joint_names", "meta")
"""The arrays of a file, in order; programs may rely on them."""

_EPOCH = (1980, 1, 1, 0, 0, 0)
_DAMAGE = (zipfile.BadZipFile, zlib.error, KeyError, ValueError, EOFError, NotImplementedError, RuntimeError)


def write_npz(stream: JointStream, path: str | os.PathLike[str]) -> None:
    """Write a stream as NPZ: t, q, qd, qdd, tool, block, joint_names and meta.

    `meta` is JSON text: header, records, runs of ticks ([first, count] each) and the complete flag.
    The same stream gives the same bytes: members are stored without compression and without times.
    Raises StreamError IRL003 where the file cannot be written.
    """
    meta = {
        "header": header_to_plain(stream.header),
        "records": [record_to_plain(record) for record in stream.records],
        "ticks": _runs(stream.ticks),
        "complete": stream.complete,
    }
    arrays = {
        **{key: getattr(stream, key) for key in KEYS[:6]},
        "joint_names": np.array(stream.header.joint_names, dtype=np.str_),
        "meta": np.array(json.dumps(meta, allow_nan=False)),
    }
    with AtomicFile(path) as file, zipfile.ZipFile(file.handle, "w", zipfile.ZIP_STORED) as archive:
        for key in KEYS:
            member = zipfile.ZipInfo(f"{key}.npy", _EPOCH)
            with archive.open(member, "w", force_zip64=True) as handle:
                np.lib.format.write_array(handle, np.asarray(arrays[key], order="C"), allow_pickle=False)


def read_npz(path: str | os.PathLike[str]) -> JointStream:
    """Stream of an NPZ file that `write_npz` wrote, blocks included.

    t, qd and qdd follow from the rest and are not read. Raises StreamError: IRL001, IRL002, IRL007
    where the file cannot be read, IRL701 where it is damaged, IRL703 for ticks that do not rise,
    IRL706 for another version.
    """
    path = Path(path)
    try:
        with open_to_read(path) as handle:
            arrays = _arrays(handle)
        return _stream(path, arrays)
    except VersionError as cause:
        raise StreamError(
            report("IRL706", Place(str(path)), found=cause.found, known=FORMAT_VERSION)
        ) from cause
    except PlainFormError as cause:
        raise broken(path, "NPZ", str(cause), "meta") from cause
    except _DAMAGE as cause:
        raise broken(path, "NPZ", f"it is damaged ({cause})") from cause


def _arrays(handle: IO[bytes]) -> dict[str, Any]:
    try:
        with zipfile.ZipFile(handle) as archive:
            return {key: _member(archive, key) for key in KEYS}
    except OSError as cause:
        # A damaged directory can send the reader to an offset before the file's beginning.
        if cause.errno == errno.EINVAL:
            raise zipfile.BadZipFile("its directory is damaged") from cause
        raise


def _member(archive: zipfile.ZipFile, key: str) -> Any:
    """One array; the whole member is read first, so that its checksum is compared before anything else."""
    data = io.BytesIO(archive.read(f"{key}.npy"))
    return np.lib.format.read_array(data, allow_pickle=False)


def _stream(path: Path, arrays: dict[str, Any]) -> JointStream:
    meta = json.loads(str(arrays["meta"].item()))
    if not isinstance(meta, dict) or set(meta) != {"header", "records", "ticks", "complete"}:
        raise PlainFormError("needs header, records, ticks and complete")
    header = header_from_plain(meta["header"])
    records = tuple(record_from_plain(record) for record in meta["records"])
    if type(meta["complete"]) is not bool:
        raise PlainFormError("complete: needs true or false")
    ticks = _from_runs(meta["ticks"], len(arrays["q"]))
    check_rising(path, ticks)
    q, block, tool = (arrays[key] for key in ("q", "block", "tool"))
    return JointStream(header, records, ticks, q, block, tool, meta["complete"])


def _runs(ticks: Integers) -> list[list[int]]:
    """Ticks as [first, count] of every stretch without a gap."""
    starts = np.flatnonzero(np.diff(ticks, prepend=ticks[:1] - 2) != 1)
    counts = np.diff(starts, append=len(ticks))
    return [list(run) for run in zip(ticks[starts].tolist(), counts.tolist(), strict=True)]


def _from_runs(runs: object, rows: int) -> Integers:
    try:
        pairs = np.array(runs, dtype=np.int64).reshape(-1, 2)
    except (ValueError, TypeError, OverflowError) as cause:
        raise PlainFormError("ticks: needs pairs of counts") from cause
    if (pairs < 0).any() or int(pairs[:, 1].sum()) != rows:
        raise PlainFormError(f"ticks: {rows} rows are there, another number is said")
    parts = [np.arange(first, first + count, dtype=np.int64) for first, count in pairs.tolist()]
    return np.concatenate([np.zeros(0, np.int64), *parts])
