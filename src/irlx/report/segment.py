"""What one block becomes in a stream: its record and its rows, with what is told of them."""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.nearest_rows import NearestRows
from irlx.report.events import Slowed
from irlx.robot.limits import JointLimits
from irlx.streams.joint_stream import BlockRecord

Array = NDArray[np.float64]


class Segment(NamedTuple):
    """Rows of one block, or of the start; comes as a whole, or not at all.

    `first_tick` of M rows of `q` (M, n), `block` (M,), `tool` (M, 7) and `active` flags (M, n); the `limits`
    in force; largest path errors (m, rad).
    """

    record: BlockRecord | None
    first_tick: int
    q: Array
    block: NDArray[np.int64]
    tool: Array
    active: NDArray[np.int8]
    limits: JointLimits
    path_error: tuple[float, float] = (0.0, 0.0)
    iterations: int = 0
    slowed: tuple[Slowed, ...] = ()
    planned: bool = False
    nearest: NearestRows | None = None


class Keeper(Protocol):
    """Whoever wants the segments of a run, one after another."""

    def take(self, segment: Segment) -> None:
        """Take the next one."""
