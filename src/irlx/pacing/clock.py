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
    path lies, so another clock can be put in its place from any tick on.
    """

    s: Array
    rate: Array

    def __len__(self) -> int:
        return int(self.s.shape[0])


def programmed_clock(law: TimeLaw, ticks: int, dt: float) -> Clock:
    """Clock of the programmed time law over a whole number of ticks of `dt` s."""
    return Clock(*law.evaluate(dt * np.arange(1.0, ticks + 1.0)))
