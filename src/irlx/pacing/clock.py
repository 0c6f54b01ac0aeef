"""The path clock: which way of the path is due at which tick."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.motion.time_law import TimeLaw

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Clock:
    """Way `s` (N,) and rate ds/dt `rate` (N,) of the path at ticks 1 .. N after the start.

    s never falls, ends at the whole way, and starts and ends at rest; it says nothing of where the
    path lies, so another clock can be put in its place from any tick on. In a dry run a row of it stands
    for `ticks_a_row` ticks.
    """

    s: Array
    rate: Array
    ticks_a_row: float = 1.0

    def __len__(self) -> int:
        return int(self.s.shape[0])


def programmed_clock(law: TimeLaw, ticks: int, dt: float, rows: int | None = None) -> Clock:
    """Clock of the programmed time law over a whole number of ticks of `dt` s, in as many rows or fewer."""
    rows = ticks if rows is None else rows
    return Clock(*law.evaluate(ticks / rows * dt * np.arange(1.0, rows + 1.0)), ticks / rows)
