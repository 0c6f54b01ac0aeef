"""Rows cut to portions of one size, so that what is written does not depend on how they came."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from irlx.streams.scan import RowBatch


class RowPortions:
    """Takes batches of rows of n `joints`, gives portions of `size` rows, and at last what is left.

    A portion is valid until the next rows are put.
    """

    def __init__(self, joints: int, size: int) -> None:
        counts = np.empty(size, np.int64), np.empty(size, np.int64)
        self._rows = RowBatch(counts[0], np.empty((size, joints)), counts[1], np.empty((size, 7)))
        self._size = size
        self._held = 0

    def put(self, batch: RowBatch) -> Iterator[RowBatch]:
        """Take rows; gives every portion that they fill."""
        given = batch.ticks, batch.q, batch.block, batch.tool
        start = 0
        while start < len(batch.ticks):
            taken = min(self._size - self._held, len(batch.ticks) - start)
            for own, rows in zip(self._rows[:4], given, strict=True):
                own[self._held : self._held + taken] = rows[start : start + taken]
            self._held += taken
            start += taken
            if self._held == self._size:
                yield self.rest()

    def rest(self) -> RowBatch:
        """The rows that are held, maybe none; they are held no more."""
        held, self._held = self._held, 0
        return self._rows.part(slice(0, held))
