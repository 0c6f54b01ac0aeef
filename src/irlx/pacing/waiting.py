"""Time that passes while the robot stands."""

from __future__ import annotations

from math import ceil

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import PauseBlock, WaitBlock
from irlx.diagnostics import Place, report
from irlx.motion.whole_ticks import MOST_TICKS
from irlx.pacing.errors import PacingError
from irlx.pacing.resolution import EVERY_TICK, Resolution
from irlx.pacing.rows import MotionRows
from irlx.promises import TICK_SHARE
from irlx.robot.kinematics import Kinematics

Array = NDArray[np.float64]


def ticks_of_wait(duration: float, dt: float) -> int:
    """Whole ticks of `dt` s that last at least `duration` s; what exceeds them by 1e-6 of one is rounding."""
    return max(0, ceil(duration / dt - TICK_SHARE))


def waited(
    block: WaitBlock | PauseBlock,
    q: Array,
    dt: float,
    first_tick: int,
    kinematics: Kinematics,
    place: Place,
    resolution: Resolution = EVERY_TICK,
) -> MotionRows | None:
    """Rows of a robot that stands at q (n,) for the time of a WAIT or PAUSE; None where it takes no tick.

    Raises PacingError, IRL425, for a wait of too many ticks.
    """
    if not block.duration / dt <= MOST_TICKS:
        shown = f"{block.duration:.7g}", f"{block.duration / dt:.7g}"
        raise PacingError(report("IRL425", place, duration=shown[0], ticks=shown[1], most=str(MOST_TICKS)))
    ticks = ticks_of_wait(block.duration, dt)
    if ticks == 0:
        return None
    rotation, position = kinematics.tool_pose(q)
    rows = resolution.rows_of(ticks)
    nothing = np.zeros(rows)
    return MotionRows(
        block,
        first_tick,
        np.tile(q, (rows, 1)),
        np.tile(position, (rows, 1)),
        np.tile(rotation, (rows, 1, 1)),
        nothing,
        nothing,
        np.zeros((rows, q.size), dtype=np.int8),
        nothing,
        1.0,
        0,
        span=ticks,
    )
