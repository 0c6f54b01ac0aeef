"""Streams in portions: header, block records, batches of rows and an end, one after the other."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from irlx.streams.joint_stream import BlockRecord, Floats, Integers, JointStream, StreamHeader


class StatedRates(NamedTuple):
    """What a file itself says of N rows: t (N,) s, `qd` and `qdd` (N, n) rad | m per s, s2."""

    t: Floats
    qd: Floats
    qdd: Floats


class RowBatch(NamedTuple):
    """Consecutive rows: ticks (N,), q (N, n), block (N,), tool (N, 7) as in `JointStream`.

    `rates` is what the file itself states of times and rates, None where the format has none. Arrays
    are not to be changed.
    """

    ticks: Integers
    q: Floats
    block: Integers
    tool: Floats
    rates: StatedRates | None = None

    def part(self, rows: slice) -> RowBatch:
        """Some of the rows, as views."""
        if rows == slice(0, len(self.ticks)):
            return self
        rates = None if self.rates is None else StatedRates(*(array[rows] for array in self.rates))
        return RowBatch(self.ticks[rows], self.q[rows], self.block[rows], self.tool[rows], rates)


@dataclass(frozen=True)
class StreamEnd:
    """The last item of a scan: `complete` is False where the run or the file did not come to its end."""

    complete: bool


ScanItem = StreamHeader | BlockRecord | RowBatch | StreamEnd
"""A scan is an iterator of these: one header first, one end last, records and rows between them."""


_PORTION = 4096


def scan_of(stream: JointStream) -> Iterator[ScanItem]:
    """A stream in memory as a scan, like that of a file: header, all records, rows in portions, the end."""
    yield stream.header
    yield from stream.records
    yield from _rows_of(stream, 0, len(stream.ticks))
    yield StreamEnd(stream.complete)


def in_order(stream: JointStream) -> Iterator[ScanItem]:
    """A stream in memory as a scan in which each block record stands after the row of its tick."""
    yield stream.header
    done = 0
    for record in stream.records:
        upto = int(stream.ticks.searchsorted(record.tick, side="right"))
        yield from _rows_of(stream, done, upto)
        done = max(done, upto)
        yield record
    yield from _rows_of(stream, done, len(stream.ticks))
    yield StreamEnd(stream.complete)


def in_file_order(scan: Iterator[ScanItem]) -> Iterator[ScanItem]:
    """The scan with each block record after the row of its tick, wherever the records stood.

    Records that come early are kept until their row is out.
    """
    waiting: deque[BlockRecord] = deque()
    last = -1
    for item in scan:
        if isinstance(item, RowBatch) and len(item.ticks):
            done = 0
            while waiting and waiting[0].tick <= item.ticks[-1]:
                upto = int(item.ticks.searchsorted(waiting[0].tick, side="right"))
                if upto > done:
                    yield item.part(slice(done, upto))
                    done = upto
                yield waiting.popleft()
            if done < len(item.ticks):
                yield item.part(slice(done, len(item.ticks)))
            last = int(item.ticks[-1])
        elif isinstance(item, BlockRecord) and (waiting or item.tick > last):
            waiting.append(item)
        else:
            if isinstance(item, StreamEnd):
                yield from waiting
            yield item


def _rows_of(stream: JointStream, begin: int, end: int) -> Iterator[RowBatch]:
    for start in range(begin, end, _PORTION):
        part = slice(start, min(start + _PORTION, end))
        yield RowBatch(stream.ticks[part], stream.q[part], stream.block[part], stream.tool[part])


def collect(scan: Iterator[ScanItem]) -> JointStream:
    """Stream of everything that a scan gives; raises what the scan raises.

    Raises ValueError for items that are no scan: header first, end last.
    """
    header = next(scan, None)
    if not isinstance(header, StreamHeader):
        raise ValueError("a scan begins with the header")
    records: list[BlockRecord] = []
    batches = [no_rows(header.joints)]
    end: StreamEnd | None = None
    for item in scan:
        if isinstance(item, BlockRecord):
            records.append(item)
        elif isinstance(item, RowBatch):
            # Rates follow from the rest; to keep them would double the memory.
            batches.append(item._replace(rates=None))
        elif isinstance(item, StreamEnd):
            end = item
    if end is None:
        raise ValueError("a scan ends with its end")
    ticks, block = (np.concatenate([batch[field] for batch in batches]) for field in (0, 2))
    q, tool = (np.concatenate([batch[field] for batch in batches]) for field in (1, 3))
    return JointStream(header, tuple(records), ticks, q, block, tool, end.complete)


def no_rows(joints: int) -> RowBatch:
    """Batch without rows."""
    counts = np.zeros(0, np.int64)
    return RowBatch(counts, np.zeros((0, joints)), counts, np.zeros((0, 7)))


def rising_rows(ticks: Integers, last: int) -> int:
    """How many of the leading ticks (N,) rise strictly from `last` on."""
    if len(ticks) and ticks[0] <= last:
        return 0
    falls = ticks[1:] <= ticks[:-1]
    return int(np.argmax(falls)) + 1 if falls.any() else len(ticks)
