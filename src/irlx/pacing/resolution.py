"""How finely motions are worked out: every tick for a stream, coarser for a dry run."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

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
