"""A stop-to-stop motion takes a whole number of ticks, so that its last sample is the target."""

from __future__ import annotations

from math import ceil

_FREE_EXCESS = 1e-6


def whole_ticks(duration: float, dt: float) -> int:
    """Number of ticks of `dt` s for a motion of `duration` s, at least 1, rounded up.

    An excess below 1e-6 of a tick is rounding of the duration and takes no further tick.
    """
    return max(1, ceil(duration / dt - _FREE_EXCESS))
