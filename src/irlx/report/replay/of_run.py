"""A finished run in memory -> its replay."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.nearest_rows import NearestRows
from irlx.report.replay.data import Replay
from irlx.report.replay.frames import MOST_FRAMES
from irlx.report.replay.gathering import Gathering
from irlx.report.replay.source import ReplaySource
from irlx.report.segment import Segment

if TYPE_CHECKING:
    from irlx.report.run import Run


def replay_of(run: Run, source: ReplaySource, most: int = MOST_FRAMES) -> Replay:
    """The replay of a run with at most so many frames."""
    gathering = Gathering(run.header, most)
    for segment in _segments(run):
        gathering.take(segment)
    for message in run.messages:
        gathering.hear(message)
    return Replay(run.header, gathering.found, source, run.summary, run.events, run.diagnostics)


def _segments(run: Run) -> Iterator[Segment]:
    """Records and rows of the run in the order in which they came; rows under one set of limits at a time."""
    stream = run.stream
    rows = len(stream.ticks)
    starts = {tick: limits for tick, limits in run.limits if tick < rows}
    # A block recorded at tick k begins behind row k.
    begun = (record.tick + 1 for record in stream.records if record.tick < rows)
    cuts = sorted({0, rows, *starts, *begun, *_changes(run.clearances.watched)})
    waiting = list(reversed(stream.records))
    limits = run.header.limits
    for first, last in pairwise(cuts):
        limits = starts.get(first, limits)
        while waiting and waiting[-1].tick < first:
            yield _part(run, 0, 0)._replace(record=waiting.pop())
        yield _part(run, first, last)._replace(limits=limits)
    while waiting:
        yield _part(run, 0, 0)._replace(record=waiting.pop())


def _changes(watched: NDArray[np.bool_]) -> list[int]:
    """Rows of N that are other than the one before."""
    return [int(row) + 1 for row in np.flatnonzero(watched[1:] != watched[:-1])]


def _part(run: Run, first: int, last: int) -> Segment:
    stream, near = run.stream, run.clearances
    part = slice(first, last)
    nearest = None
    if last > first and near.watched.size and near.watched[first]:
        nearest = NearestRows(near.pair[part], near.distance[part], near.pairs, near.margin)
    still = np.zeros((last - first, run.header.joints), dtype=np.int8)
    own = stream.q[part], stream.block[part], stream.tool[part]
    return Segment(None, first, *own, still, run.header.limits, nearest=nearest)
