"""NPZ: the arrays of a stream for numpy, with everything else as JSON text under `meta`."""

from __future__ import annotations

import json
import os
import tempfile
import zipfile
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import IO, Any

import numpy as np

from irlx.streams.atomic import AtomicFile
from irlx.streams.error import cannot_write
from irlx.streams.header_plain import header_to_plain, record_to_plain
from irlx.streams.joint_stream import BlockRecord, StreamHeader
from irlx.streams.rates import Rates
from irlx.streams.scan import RowBatch
from irlx.streams.writer import StreamWriter

KEYS = ("t", "q", "qd", "qdd", "tool", "block", "joint_names", "meta")
"""The arrays of a file, in order; programs may rely on them."""

_ROW_KEYS = KEYS[:6]
_EPOCH = (1980, 1, 1, 0, 0, 0)
_PORTION = 1 << 20


class NpzWriter(StreamWriter):
    """Writes one stream as NPZ: t, q, qd, qdd, tool, block, joint_names and meta.

    `meta` is JSON text: header, records, runs of ticks ([first, count] each) and the complete flag.
    The same stream gives the same bytes: members are stored without compression and without times. Until it
    is closed, rows are in files without names in the same folder. See `StreamWriter`.
    """

    def __init__(self, path: str | os.PathLike[str], header: StreamHeader) -> None:
        super().__init__(path, header)
        self._file = AtomicFile(path)
        self._rates = Rates(header)
        self._records: list[dict[str, Any]] = []
        self._runs: list[list[int]] = []
        self._parts = ExitStack()
        folder = Path(os.path.realpath(path)).parent
        try:
            self._rows: dict[str, IO[bytes]] = {
                key: self._parts.enter_context(_nameless(folder)) for key in _ROW_KEYS
            }
        except OSError as cause:
            self._discard()
            raise cannot_write(self.path, cause) from cause

    def _put_block(self, record: BlockRecord) -> None:
        self._records.append(record_to_plain(record))

    def _put_rows(self, batch: RowBatch) -> None:
        rates = self._rates.of(batch.ticks, batch.q)
        arrays = {**rates._asdict(), "q": batch.q, "tool": batch.tool, "block": batch.block}
        try:
            for key, handle in self._rows.items():
                handle.write(np.ascontiguousarray(arrays[key]).data)
        except OSError as cause:
            self.abort()
            raise cannot_write(self.path, cause) from cause
        for tick in _firsts(batch.ticks):
            self._count(*tick)

    def _count(self, first: int, count: int) -> None:
        """Note a run of ticks, joined to the one before where there is no gap."""
        last = self._runs[-1] if self._runs else None
        if last is not None and last[0] + last[1] == first:
            last[1] += count
        else:
            self._runs.append([first, count])

    def _put_end(self, complete: bool) -> None:
        meta = {
            "header": header_to_plain(self.header),
            "records": self._records,
            "ticks": self._runs,
            "complete": complete,
        }
        texts = {
            "joint_names": np.array(self.header.joint_names, dtype=np.str_),
            "meta": np.array(json.dumps(meta, allow_nan=False)),
        }
        try:
            with zipfile.ZipFile(self._file.handle, "w", zipfile.ZIP_STORED) as archive:
                for key in KEYS:
                    with archive.open(zipfile.ZipInfo(f"{key}.npy", _EPOCH), "w", force_zip64=True) as member:
                        if key in texts:
                            np.lib.format.write_array(member, texts[key], allow_pickle=False)
                        else:
                            self._copy(key, member)
        except (OSError, ValueError) as cause:
            # An archive whose member could not be ended says so as ValueError.
            self.abort()
            raise cannot_write(self.path, cause) from cause

    def _copy(self, key: str, member: IO[bytes]) -> None:
        """One array of rows: its head, and what was written of it."""
        width = {"q": self.header.joints, "qd": self.header.joints, "qdd": self.header.joints, "tool": 7}
        shape = (self.rows, width[key]) if key in width else (self.rows,)
        kind = np.dtype(np.int64 if key == "block" else np.float64)
        head = {"descr": np.lib.format.dtype_to_descr(kind), "fortran_order": False, "shape": shape}
        np.lib.format.write_array_header_1_0(member, head)
        source = self._rows[key]
        source.seek(0)
        while portion := source.read(_PORTION):
            member.write(portion)

    def _commit(self, name: Path | None) -> None:
        self._forget_parts()
        self._file.commit(name)

    def _discard(self) -> None:
        self._forget_parts()
        self._file.discard()

    def _forget_parts(self) -> None:
        # On a full disk closing fails as well, for what is still to be written.
        with suppress(OSError):
            self._parts.close()


def _nameless(folder: Path) -> IO[bytes]:
    """A file on the disk of a folder that is gone when it is closed."""
    return tempfile.TemporaryFile(dir=folder, prefix=".irlx-")


def _firsts(ticks: Any) -> list[tuple[int, int]]:
    """Ticks (N,) as (first, count) of every stretch without a gap."""
    starts = np.flatnonzero(np.diff(ticks, prepend=ticks[:1] - 2) != 1)
    counts = np.diff(starts, append=len(ticks))
    return list(zip(ticks[starts].tolist(), counts.tolist(), strict=True))
