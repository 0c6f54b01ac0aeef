"""What all writers of streams are: they take blocks and rows as they come, and keep no rows."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from pathlib import Path
from types import TracebackType
from typing import TypeVar

import numpy as np

from irlx.diagnostics import Place, report
from irlx.streams.error import StreamError
from irlx.streams.joint_stream import BlockRecord, Floats, Integers, StreamHeader
from irlx.streams.scan import RowBatch

Own = TypeVar("Own", bound="StreamWriter")

_ROWS = 1024


class StreamWriter(ABC):
    """Writes one stream to `path`, which appears only when `close` is called.

    As a context manager it closes a complete stream at the end of the block unless that was done
    before, and removes what it has written where the block raises. After an interruption that
    should leave a partial stream call ``close(complete=False)``. Raises StreamError: IRL003 for
    failures of the file system, IRL708 for samples or blocks that make no stream.
    """

    def __init__(self, path: str | os.PathLike[str], header: StreamHeader) -> None:
        self.path = Path(path)
        self.header = header
        self.rows = 0
        """Rows taken so far."""
        self._last_tick = -1
        self._last_block_tick = 0
        self._open = True

    def block(self, record: BlockRecord) -> None:
        """Take the record of a block that begins behind the rows taken so far; ticks of blocks never fall."""
        if record.tick < self._last_block_tick:
            raise self.refusal(f"block {record.block.id} begins at tick {record.tick}, before the last one")
        self._last_block_tick = record.tick
        self._put_block(record)

    def samples(self, ticks: Integers, q: Floats, block: Integers, tool: Floats) -> None:
        """Take a batch of rows: ticks (N,) rising, q (N, n), block (N,) ids, tool (N, 7); all finite."""
        self._check(ticks, q, block, tool)
        for start in range(0, len(ticks), _ROWS):
            part = slice(start, start + _ROWS)
            self._put_rows(RowBatch(ticks[part], q[part], block[part], tool[part]))
        self.rows += len(ticks)
        if len(ticks):
            self._last_tick = int(ticks[-1])

    def close(self, complete: bool = True, name: str | os.PathLike[str] | None = None) -> None:
        """End the stream and let the file appear, under another `name` where one is given.

        `complete` False marks a partial stream.
        """
        if not self._open:
            return
        self._put_end(complete)
        self._open = False
        self._commit(None if name is None else Path(name))

    def abort(self) -> None:
        """Remove what was written; `path` stays as it was."""
        self._open = False
        self._discard()

    def refusal(self, reason: str) -> StreamError:
        """IRL708, the file being given up."""
        self.abort()
        return StreamError(report("IRL708", Place(str(self.path)), reason=reason))

    @abstractmethod
    def _put_block(self, record: BlockRecord) -> None:
        """Write a block record, where the format has them."""

    @abstractmethod
    def _put_rows(self, batch: RowBatch) -> None:
        """Write at most `_ROWS` checked rows."""

    @abstractmethod
    def _put_end(self, complete: bool) -> None:
        """Write what ends the file; `rows` were taken."""

    @abstractmethod
    def _commit(self, name: Path | None) -> None:
        """Let the file appear."""

    @abstractmethod
    def _discard(self) -> None:
        """Remove what was written; harmless when called twice."""

    def _check(self, ticks: Integers, q: Floats, block: Integers, tool: Floats) -> None:
        rows = len(ticks)
        shapes = {"q": (q, (rows, self.header.joints)), "block": (block, (rows,)), "tool": (tool, (rows, 7))}
        for name, (array, shape) in shapes.items():
            if array.shape != shape:
                raise self.refusal(f"{name} has shape {array.shape}, {shape} is due")
        if not (np.isfinite(q).all() and np.isfinite(tool).all()):
            bad = int(np.argmin(np.isfinite(q).all(axis=1) & np.isfinite(tool).all(axis=1)))
            raise self.refusal(f"the sample of tick {ticks[bad]} is not finite")
        if rows and (ticks[0] <= self._last_tick or (np.diff(ticks) <= 0).any()):
            raise self.refusal(f"ticks do not rise from {self._last_tick} on")

    def __enter__(self: Own) -> Own:
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
