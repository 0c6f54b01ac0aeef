"""Samples of what a run executes, as soon as it is there."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from irlx.report.segment import Segment
from irlx.streams.joint_stream import StreamHeader
from irlx.streams.rates import Rates
from irlx.streams.sample import Sample


class Samples:
    """Keeps the segments that have come since they were taken out last."""

    def __init__(self, header: StreamHeader) -> None:
        self._rates = Rates(header)
        self._waiting: list[Segment] = []

    def take(self, segment: Segment) -> None:
        """Take the next segment."""
        if len(segment.q):
            self._waiting.append(segment)

    def new(self) -> Iterator[Sample]:
        """Samples of the rows that have come since the last call; their arrays are their own."""
        while self._waiting:
            segment = self._waiting.pop(0)
            ticks = segment.first_tick + np.arange(len(segment.q), dtype=np.int64)
            t, qd, qdd = self._rates.of(ticks, segment.q)
            # The robot goes on from the very rows of the segment.
            q, block = segment.q.copy(), segment.block.tolist()
            columns = ticks.tolist(), t.tolist(), q, qd, qdd, segment.tool, block
            for row in zip(*columns, strict=True):
                yield Sample(*row)
