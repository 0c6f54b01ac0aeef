"""A stream that is read once where it is short enough to be kept, and anew each time where it is not."""

from __future__ import annotations

from collections.abc import Iterator

from irlx.streams.error import StreamError
from irlx.streams.scan import RowBatch, ScanItem
from irlx.verifier.outline import Scans

MOST = 48 << 20
"""Bytes of rows that are kept: 200,000 rows of seven joints with the rates of a CSV, or 390,000 without."""


class Remembered:
    """Scans of the same stream: what the first one gave, the others give again, its damage included.

    To read a text back costs more than all checks of its rows. Memory is bounded: of a stream with more than
    `MOST` bytes of rows nothing is kept.
    """

    def __init__(self, scans: Scans) -> None:
        self._scans = scans
        self._items: list[ScanItem] | None = None
        self._damage: StreamError | None = None

    def __call__(self) -> Iterator[ScanItem]:
        """A scan from the beginning."""
        if self._items is None:
            yield from self._read()
            return
        yield from self._items
        if self._damage is not None:
            raise self._damage

    def _read(self) -> Iterator[ScanItem]:
        items: list[ScanItem] | None = []
        size = 0
        try:
            for item in self._scans():
                size += _bytes_of(item)
                if size > MOST:
                    items = None
                if items is not None:
                    items.append(item)
                yield item
        except StreamError as damage:
            self._items, self._damage = items, damage
            raise
        self._items = items


def _bytes_of(item: ScanItem) -> int:
    if not isinstance(item, RowBatch):
        return 0
    rates = () if item.rates is None else item.rates
    return sum(array.nbytes for array in (*item[:4], *rates))
