"""A stop-to-stop motion takes a whole number of ticks, so that its last sample is the target."""

from __future__ import annotations

from math import ceil, isfinite
from typing import Any

from irlx.diagnostics import Place, report
from irlx.motion.errors import MotionError
from irlx.promises import TICK_SHARE

MOST_TICKS = 2_000_000
"""Most ticks of one move: beyond, its rows would not fit a machine's memory, and nobody means it."""


def whole_ticks(duration: float, dt: float) -> int:
    """Number of ticks of `dt` s for a motion of `duration` s, at least 1, rounded up.

    An excess below 1e-6 of a tick is rounding of the duration and takes no further tick.
    """
    return max(1, ceil(duration / dt - TICK_SHARE))


def ticks_of_move(duration: float, dt: float, place: Place) -> int:
    """`whole_ticks` of a move at `place`. Raises MotionError, IRL425, where they are too many.

    `duration` may be infinite or undefined, as that of a way longer than all numbers.
    """
    if not duration / dt <= MOST_TICKS:
        shown = [f"{value:.7g}" if isfinite(value) else "over 1E308" for value in (duration, duration / dt)]
        data: dict[str, Any] = {"duration": shown[0], "ticks": shown[1], "most": MOST_TICKS}
        raise MotionError(report("IRL425", place, **data))
    return whole_ticks(duration, dt)
