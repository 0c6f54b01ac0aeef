"""Writer of IRDATA-like files: takes blocks and samples as they come, keeps nothing in memory."""

from __future__ import annotations

import hashlib
import os
from types import TracebackType

import numpy as np

from irlx.diagnostics import Place, report
from irlx.streams.atomic import AtomicFile
from irlx.streams.error import StreamError
from irlx.streams.irdata.block import block_operands
from irlx.streams.irdata.codes import END
from irlx.streams.irdata.header import header_records
from irlx.streams.irdata.record import Value, record_text
from irlx.streams.irdata.samples import samples_text
from irlx.streams.joint_stream import BlockRecord, Floats, Integers, StreamHeader
from irlx.streams.scan import RowBatch

_ROWS = 1024


class IrdataWriter:
    """Writes one stream to `path`, which appears only when `close` is called.

    As a context manager it closes a complete stream at the end of the block unless that was done
    before, and removes the temporary file where the block raises. After an interruption that
    should leave a partial stream call ``close(complete=False)``. Raises StreamError: IRL003 for
    failures of the file system, IRL708 for samples or blocks that make no stream.
    """

    def __init__(self, path: str | os.PathLike[str], header: StreamHeader) -> None:
        self._header = header
        self._file = AtomicFile(path)
        self._digest = hashlib.sha256()
        self._number = 1
        self._samples = 0
        self._last_tick = -1
        self._last_block_tick = 0
        self._open = True
        for code, operands in header_records(header):
            self._record(code, operands)

    def block(self, record: BlockRecord) -> None:
        """Write the record of a block that begins; ticks of blocks never fall."""
        if record.tick < self._last_block_tick:
            raise self._refusal(f"block {record.block.id} begins at tick {record.tick}, before the last one")
        self._last_block_tick = record.tick
        try:
            code, operands = block_operands(record)
        except KeyError as cause:
            raise self._refusal(f"it has no record for {cause.args[0]}") from cause
        self._record(code, operands)

    def samples(self, ticks: Integers, q: Floats, block: Integers, tool: Floats) -> None:
        """Write a batch of rows: ticks (N,) rising, q (N, n), block (N,) ids, tool (N, 7); all finite."""
        self._check(ticks, q, block, tool)
        for start in range(0, len(ticks), _ROWS):
            part = slice(start, start + _ROWS)
            batch = RowBatch(ticks[part], q[part], block[part], tool[part])
            self._write(samples_text(self._number, batch))
            self._number += len(batch.ticks)
        self._samples += len(ticks)
        if len(ticks):
            self._last_tick = int(ticks[-1])

    def close(self, complete: bool = True) -> None:
        """Write the end record and let the file appear; `complete` False marks a partial stream."""
        if not self._open:
            return
        checksum = self._digest.hexdigest()
        self._record(END, {"samples": self._samples, "complete": complete, "sha256": checksum})
        self._open = False
        self._file.commit()

    def abort(self) -> None:
        """Remove the temporary file; `path` stays as it was."""
        self._open = False
        self._file.discard()

    def _record(self, code: int, operands: dict[str, Value]) -> None:
        self._write(record_text(self._number, code, operands))
        self._number += 1

    def _write(self, data: bytes) -> None:
        self._digest.update(data)
        self._file.write(data)

    def _check(self, ticks: Integers, q: Floats, block: Integers, tool: Floats) -> None:
        rows = len(ticks)
        shapes = {"q": (q, (rows, self._header.joints)), "block": (block, (rows,)), "tool": (tool, (rows, 7))}
        for name, (array, shape) in shapes.items():
            if array.shape != shape:
                raise self._refusal(f"{name} has shape {array.shape}, {shape} is due")
        if not (np.isfinite(q).all() and np.isfinite(tool).all()):
            bad = int(np.argmin(np.isfinite(q).all(axis=1) & np.isfinite(tool).all(axis=1)))
            raise self._refusal(f"the sample of tick {ticks[bad]} is not finite")
        if rows and (ticks[0] <= self._last_tick or (np.diff(ticks) <= 0).any()):
            raise self._refusal(f"ticks do not rise from {self._last_tick} on")

    def _refusal(self, reason: str) -> StreamError:
        self.abort()
        return StreamError(report("IRL708", Place(str(self._file.path)), reason=reason))

    def __enter__(self) -> IrdataWriter:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if kind is None:
            self.close()
        elif self._open:
            self.abort()
