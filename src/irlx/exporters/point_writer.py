"""Programs of single moves: every posture is a point that is passed, except where the robot stands still."""

from __future__ import annotations

import os
from abc import abstractmethod
from typing import NamedTuple

import numpy as np

from irlx.exporters.program_writer import ProgramWriter
from irlx.streams.joint_stream import Floats, Integers, StreamHeader
from irlx.streams.scan import RowBatch


class Points(NamedTuple):
    """Consecutive postures, each other than the one before: `q` (N, n) in rad or m.

    `steps` (N,) are the ticks from the posture before, 0 of the very first one; `holds` (N,) the ticks for
    which the robot then stands still.
    """

    q: Floats
    steps: Integers
    holds: Integers


class PointWriter(ProgramWriter):
    """A writer that puts rows which are the same to the last digit written together as one point and a wait.

    A stop must be seen before the point is written that it belongs to, so the last posture is kept back.
    """

    def __init__(self, path: str | os.PathLike[str], header: StreamHeader, incomplete: bool = False) -> None:
        super().__init__(path, header, incomplete)
        self._kept = np.zeros((0, header.joints))
        """First and last row of the posture that is kept back; none before the first row."""
        self._kept_ticks = np.zeros(0, np.int64)
        self._kept_step = 0

    @abstractmethod
    def _fronts(self) -> list[str]:
        """What stands before each value of a line."""

    @abstractmethod
    def _end_of_line(self, step: int, hold: int, passes: bool, first: bool) -> str:
        """What stands behind the values of a point, line ends included.

        `step` ticks from the point before, `hold` ticks to stand there; whether it is passed, and whether it
        is the first one.
        """

    def _put_rows(self, batch: RowBatch) -> None:
        ticks = np.concatenate((self._kept_ticks, batch.ticks))
        q = np.concatenate((self._kept, batch.q))
        changed = np.ones(len(q), dtype=bool)
        # What is written alike is one point: a controller would be told to go nowhere.
        shown = np.rint(self.axes.values(q) * 10.0**self.profile.digits)
        changed[1:] = (shown[1:] != shown[:-1]).any(axis=1)
        starts = np.flatnonzero(changed)
        ends = np.append(starts[1:], len(q)) - 1
        steps = np.empty(len(starts), np.int64)
        steps[0] = self._kept_step
        steps[1:] = ticks[starts[1:]] - ticks[ends[:-1]]
        points = Points(q[starts], steps, ticks[ends] - ticks[starts])
        self._put_points(Points(points.q[:-1], points.steps[:-1], points.holds[:-1]))
        kept = [starts[-1], ends[-1]]
        self._kept, self._kept_ticks, self._kept_step = q[kept], ticks[kept], int(steps[-1])

    def _tail(self) -> None:
        hold = int(self._kept_ticks[1] - self._kept_ticks[0])
        points = Points(self._kept[:1], np.array([self._kept_step]), np.array([hold]))
        self._put_points(points)

    def _put_points(self, points: Points) -> None:
        """Write points. The last one of a program is not passed: what ends at rest has a hold there."""
        if not len(points.q):
            return
        first = not self._points
        self._count(len(points.q))
        kinds = list(zip(points.steps.tolist(), points.holds.tolist(), strict=True))
        # Few kinds of points make up a program.
        ends = {
            kind: self._end_of_line(*kind, passes=not kind[1], first=False).encode() for kind in set(kinds)
        }
        tails = [ends[kind] for kind in kinds]
        if first:
            tails[0] = self._end_of_line(*kinds[0], passes=False, first=True).encode()
        self._put_values(self._fronts(), points.q, tails)

    def _seconds(self, ticks: int) -> str:
        """A number of ticks in s, exactly, as few digits as it takes: ``0.05``."""
        ns = ticks * self.header.tick_ns
        return f"{ns // 10**9}.{ns % 10**9:09d}".rstrip("0").rstrip(".")
