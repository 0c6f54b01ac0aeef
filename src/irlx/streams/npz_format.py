"""NPZ: the arrays of a stream for numpy, with everything else as JSON text under `meta`."""

from __future__ import annotations

import json
import os
import zipfile

import numpy as np

from irlx.streams.atomic import AtomicFile
from irlx.streams.header_plain import (
    header_to_plain,
    record_to_plain,
)
from irlx.streams.joint_stream import Integers, JointStream

KEYS = ("t", "q", "qd", "qdd", "tool", "block", "joint_names", "meta")
"""The arrays of a file, in order; programs may rely on them."""

_EPOCH = (1980, 1, 1, 0, 0, 0)


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


def _runs(ticks: Integers) -> list[list[int]]:
    """Ticks as [first, count] of every stretch without a gap."""
    starts = np.flatnonzero(np.diff(ticks, prepend=ticks[:1] - 2) != 1)
    counts = np.diff(starts, append=len(ticks))
    return [list(run) for run in zip(ticks[starts].tolist(), counts.tolist(), strict=True)]
