"""Keeps the worst value and the first offence of one check while rows are looked at in portions."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from irlx.streams.joint_stream import Floats, Integers, JointStream
from irlx.verifier.report import FAILED, NOT_CHECKED, OK, Check, Finding


class Tally:
    """One check in the making: values of rows (R,) or of rows and joints (R, n) are added in any portions."""

    def __init__(self, name: str, unit: str, stream: JointStream, lines: dict[int, int]) -> None:
        self.name = name
        self.unit = unit
        self.detail = ""
        self.values = 0
        self._stream = stream
        self._lines = lines
        self._worst: Finding | None = None
        self._worst_rank = -np.inf
        self._first: Finding | None = None

    def add(
        self,
        rows: Integers,
        value: Floats,
        allowed: ArrayLike,
        offends: NDArray[np.bool_] | None = None,
        rank: Floats | None = None,
    ) -> None:
        """Add the values of `rows` (indices into the stream).

        By default a value offends where it is not <= `allowed` (so that nan does), and the worst is
        the largest. `rank` orders values otherwise; rank -inf never becomes the worst.
        """
        if value.size == 0:
            return
        self.values += value.size
        allowed = np.broadcast_to(np.asarray(allowed, dtype=np.float64), value.shape)
        offends = ~(value <= allowed) if offends is None else offends
        rank = value if rank is None else rank
        top = int(np.argmax(rank))
        if rank.flat[top] > self._worst_rank:
            self._worst_rank = float(rank.flat[top])
            self._worst = self._finding(rows, value, allowed, top)
        if offends.any():
            found = self._finding(rows, value, allowed, int(np.argmax(offends)))
            if self._first is None or found.tick < self._first.tick:
                self._first = found

    def _finding(self, rows: Integers, value: Floats, allowed: Floats, flat: int) -> Finding:
        row = int(rows[flat if value.ndim == 1 else flat // value.shape[1]])
        joint = None if value.ndim == 1 else self._stream.header.joint_names[flat % value.shape[1]]
        block = int(self._stream.block[row])
        return Finding(
            float(value.flat[flat]),
            float(allowed.flat[flat]),
            int(self._stream.ticks[row]),
            joint,
            block,
            self._lines.get(block),
        )

    @property
    def first(self) -> Finding | None:
        """The first offence so far."""
        return self._first

    def check(self, nothing: str = "") -> Check:
        """The finished check; where no value was added and `nothing` says why, it was not made."""
        if not self.values and nothing:
            return Check(self.name, NOT_CHECKED, self.unit, detail=nothing)
        status = OK if self._first is None else FAILED
        return Check(self.name, status, self.unit, self._worst, self._first, self.detail)
