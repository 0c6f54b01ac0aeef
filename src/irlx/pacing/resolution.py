"""How finely motions are worked out: every tick for a stream, coarser for a dry run."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.slowdown.grid import FINE, Spacing

LEAST_ROWS = 8
"""Rows of a move below which more of them cost nothing and less of them say little."""


@dataclass(frozen=True)
class Resolution:
    """Ticks a row stands for at most, and how plans cut their paths.

    Moves take the same whole ticks at any resolution: rows are spread evenly over them.
    """

    ticks_a_row: int = 1
    spacing: Spacing = FINE

    @property
    def is_coarse(self) -> bool:
        """Whether rows stand for more than a tick each."""
        return self.ticks_a_row > 1

    def rows_of(self, ticks: int) -> int:
        """Rows of a motion of so many ticks, at most one a tick."""
        if not self.is_coarse:
            return ticks
        return min(ticks, max(LEAST_ROWS, ceil(ticks / self.ticks_a_row)))


EVERY_TICK = Resolution()


def ticks_before(row: int, ticks_a_row: float) -> int:
    """Whole ticks of a motion before that of its row (counted from 0), rows spread evenly over its ticks."""
    return round((row + 1) * ticks_a_row) - 1


@dataclass(frozen=True)
class RowTicks:
    """When the rows of a motion are: its first tick by number, ticks of `dt` s, `ticks_a_row` each."""

    first_tick: int
    dt: float
    ticks_a_row: float = 1.0

    def tick(self, row: int) -> int:
        """The number of the tick of a row, counted from 0."""
        return self.first_tick + ticks_before(row, self.ticks_a_row)

    def elapsed(self, rows: int) -> NDArray[np.float64]:
        """Times (N,), s, from the begin of the motion to its first N rows."""
        return np.asarray(self.dt * self.ticks_a_row * np.arange(1.0, rows + 1.0))
