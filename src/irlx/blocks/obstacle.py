"""Blocks that tell which obstacles a robot keeps clear of."""

from __future__ import annotations

from dataclasses import dataclass

from irlx.blocks.block import Block


@dataclass(frozen=True, kw_only=True)
class ObstacleBlock(Block):
    """From here on the robot keeps clear of this obstacle or group of the cell; `active` False ends it.

    `name` as the cell writes it.
    """

    name: str
    active: bool
