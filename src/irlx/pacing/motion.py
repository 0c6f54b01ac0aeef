"""One motion from stop to stop, as the moves see it that it carries out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import MoveBlock
from irlx.pacing.options import LimitsInForce
from irlx.pacing.posed import Pose
from irlx.pacing.rows import MotionRows

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Motion:
    """Rows of the first moves of several, one entry a move (None where it moves nothing), and their limits.

    `rest` is what is left of the last of these moves where the motion stops on its way, None where it does
    not. `rooms`: how far a corner to another kind of move may reach into the first and the last of the moves,
    in the unit of `MotionRows.s`: half of them, of a SPLINE half of the way to its next point. `programmed`:
    where the path of a move WITH TOLERANCE ends, off which the tool may stand. `asked` (3, 3) is the
    orientation asked for at the end, None where it is that of a posture.
    """

    rows: tuple[MotionRows | None, ...]
    in_force: LimitsInForce
    rest: MoveBlock | None = None
    rooms: tuple[float, float] = (0.0, 0.0)
    programmed: Pose | None = None
    asked: Array | None = None
