"""The planned rows of one motion as a correction sees them, from stop to stop."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import Block
from irlx.pacing.executed import Executed
from irlx.pacing.rows import MotionRows
from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]


class PlannedRow(NamedTuple):
    """A planned posture (n,), its tool pose, rotation (3, 3) and position (3,) m, and the block it is of.

    `lowest`, `highest` (n,): what the joints still reach from here on until the motion stops.
    """

    q: Array
    rotation: Array
    position: Array
    lowest: Array
    highest: Array
    block: Block | None

    def standing(self) -> PlannedRow:
        """The same row of a robot that stands here."""
        return self._replace(lowest=self.q, highest=self.q)


@dataclass(frozen=True)
class PlannedMotion:
    """Rows of a motion, planned with `limits`; the joints that are not frozen are `free` (n,)."""

    rows: tuple[PlannedRow, ...]
    limits: JointLimits
    free: NDArray[np.bool_]


def planned_motion(
    parts: Sequence[Executed], limits: JointLimits, free: NDArray[np.bool_]
) -> PlannedMotion | None:
    """The rows of blocks that one motion from stop to stop carries out, None where it has none."""
    moved = [(part.block, part.rows) for part in parts if part.rows is not None]
    if not moved:
        return None
    q = np.concatenate([rows.q for _, rows in moved])
    lowest = np.minimum.accumulate(q[::-1])[::-1]
    highest = np.maximum.accumulate(q[::-1])[::-1]
    rotation = np.concatenate([rows.tool_rotation for _, rows in moved])
    position = np.concatenate([rows.tool_position for _, rows in moved])
    blocks = [block for block, rows in moved for _ in range(len(rows))]
    rows = tuple(
        PlannedRow(*each) for each in zip(q, rotation, position, lowest, highest, blocks, strict=True)
    )
    return PlannedMotion(rows, limits, free)


def goes_on(rows: MotionRows | None, begun: bool) -> bool:
    """Whether the motion is not over with these rows of a block, or None; `begun`: it has rows before."""
    return begun if rows is None else not rows.stops
