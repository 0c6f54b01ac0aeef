"""Blocks that change what later moves refer to: the tool, and the weights of the joints."""

from __future__ import annotations

from dataclasses import dataclass

from irlx.blocks.block import Block


@dataclass(frozen=True, kw_only=True)
class ToolBlock(Block):
    """From here on the tool frame lies at this pose in the frame of the robot's tip; nothing moves.

    `position` in m, `orientation` as unit quaternion (x, y, z, w).
    """

    position: tuple[float, float, float]
    orientation: tuple[float, float, float, float]


@dataclass(frozen=True, kw_only=True)
class WeightsBlock(Block):
    """From here on these weights hold, one a joint, each greater than 0: the larger, the less it moves."""

    weights: tuple[float, ...]
