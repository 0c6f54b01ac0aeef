"""Motions as trajectories: the rows from one standstill to the next."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import IO, cast

import numpy as np

from irlx.streams.joint_stream import Floats, Integers, StreamHeader
from irlx.streams.rosbag.messages import TrajectoryForm

_IN_MEMORY = 1 << 22
_PORTION = 1 << 20


@dataclass
class Trajectory:
    """A motion that begins at `start_ns`: `count` points, the bytes of which stand in `spool`."""

    form: TrajectoryForm
    start_ns: int
    spool: IO[bytes]
    count: int = 0

    def parts(self) -> Iterator[bytes]:
        """The message in parts; can be asked for again and again."""
        self.spool.seek(0)
        yield self.form.head + self.count.to_bytes(4, "little") + self.spool.read(4)
        self.spool.seek(self.form.pad, 1)
        while part := self.spool.read(_PORTION):
            yield part

    def __len__(self) -> int:
        return len(self.form.head) + 4 + self.count * len(self.form.point) - self.form.pad


class Trajectories:
    """Cuts rows where the robot stands; what belongs to a motion that goes on is kept, if long in a file.

    A trajectory has the last row at rest before the motion, its rows, and the first row at rest behind it:
    its first and its last velocity are 0.
    """

    def __init__(self, header: StreamHeader, folder: Path) -> None:
        self._form = TrajectoryForm.of(header)
        self._tick_ns = header.tick_ns
        self._folder = folder
        self._open: Trajectory | None = None
        self._still: tuple[Integers, Floats, Floats] | None = None

    def put(self, ticks: Integers, q: Floats, qd: Floats) -> Iterator[Trajectory]:
        """Take rows; gives every trajectory that they end. It is to be closed by `close`."""
        moves = (qd != 0).any(axis=1)
        edges = [0, *(np.flatnonzero(moves[1:] != moves[:-1]) + 1).tolist(), len(ticks)]
        for begin, end in pairwise(edges):
            if begin == end:
                continue
            if moves[begin]:
                if self._open is None:
                    self._begin()
                self._add(ticks[begin:end], q[begin:end], qd[begin:end])
                continue
            if self._open is not None:
                self._add(ticks[begin : begin + 1], q[begin : begin + 1], qd[begin : begin + 1])
                whole, self._open = self._open, None
                yield whole
                whole.spool.close()
            last = slice(end - 1, end)
            self._still = ticks[last].copy(), q[last].copy(), qd[last].copy()

    def close(self) -> None:
        """Forget the motion that is not over."""
        if self._open is not None:
            self._open.spool.close()
            self._open = None

    def _begin(self) -> None:
        # The first row of a stream has no velocity: before every motion a row at rest is known.
        assert self._still is not None
        start_ns = int(self._still[0][0]) * self._tick_ns
        # Closed with the trajectory, which outlives this call.
        spool = tempfile.SpooledTemporaryFile(_IN_MEMORY, dir=str(self._folder))  # noqa: SIM115
        self._open = Trajectory(self._form, start_ns, cast("IO[bytes]", spool))
        self._add(*self._still)

    def _add(self, ticks: Integers, q: Floats, qd: Floats) -> None:
        assert self._open is not None
        self._open.spool.write(self._form.points(ticks * self._tick_ns - self._open.start_ns, q, qd))
        self._open.count += len(ticks)
