"""The tool frames in force: where the tool lies in the frame of the robot's tip, block by block."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from irlx.blocks import ToolBlock
from irlx.streams.joint_stream import BlockRecord, Floats, Integers
from irlx.verifier.geometry.rotations import from_quaternion

Pose = tuple[Floats, Floats]


@dataclass(frozen=True, eq=False)
class ToolsInForce:
    """Tools by the blocks that set them: of T rising `ids` the i-th sets tool i + 1; tool 0 is the tip.

    `positions` (T + 1, 3) m and `rotations` (T + 1, 3, 3) in the frame of the tip.
    """

    ids: Integers
    positions: Floats
    rotations: Floats

    @property
    def change(self) -> bool:
        """Whether there is any but the tip."""
        return self.ids.size > 0

    def numbers(self, blocks: Integers) -> Integers:
        """Which tool is in force in blocks (R,), by their ids."""
        return np.searchsorted(self.ids, blocks, side="left")

    def number(self, block: int) -> int:
        """Which tool is in force in one block."""
        return int(self.numbers(np.array([block]))[0])

    def placed(self, tips: Pose, numbers: Integers) -> Pose:
        """Poses of the tools of `numbers` (R,) at poses (R, 3), (R, 3, 3) of the tip."""
        if not self.change:
            return tips
        offsets = np.einsum("rij,rj->ri", tips[1], self.positions[numbers])
        return tips[0] + offsets, tips[1] @ self.rotations[numbers]


def tools_of(records: Sequence[BlockRecord]) -> ToolsInForce:
    """The tools that the blocks of a stream set."""
    blocks = [record.block for record in records if isinstance(record.block, ToolBlock)]
    blocks.sort(key=lambda block: block.id)
    positions = np.array([(0.0, 0.0, 0.0), *(block.position for block in blocks)])
    quaternions = np.array([(0.0, 0.0, 0.0, 1.0), *(block.orientation for block in blocks)])
    lengths = np.linalg.norm(quaternions, axis=1, keepdims=True)
    ids = np.array([block.id for block in blocks], dtype=np.int64)
    return ToolsInForce(ids, positions, from_quaternion(quaternions / lengths))
