"""Blocks that switch redundancy options, and the limit clauses that moves carry."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from irlx.blocks.block import Block, Origin


class LimitKind(str, Enum):
    """Which quantity of the joints a limit bounds."""

    POSITION = "POSITION"
    SPEED = "SPEED"
    ACCELERATION = "ACCELERATION"


@dataclass(frozen=True)
class JointRange:
    """Lower and upper bound of every joint: rad or m, and their time derivatives."""

    lower: tuple[float, ...]
    upper: tuple[float, ...]


@dataclass(frozen=True)
class LimitClause:
    """A limit that holds for one move and overrides the switch of the same kind; with its place."""

    kind: LimitKind
    range: JointRange
    origin: Origin


@dataclass(frozen=True, kw_only=True)
class LimitSwitchBlock(Block):
    """From here on this limit holds; `range` None switches the kind off."""

    kind: LimitKind
    range: JointRange | None


@dataclass(frozen=True, kw_only=True)
class FreezeBlock(Block):
    """From here on these joints (numbered from 1) keep their values; an empty tuple frees all."""

    joints: tuple[int, ...]


@dataclass(frozen=True, kw_only=True)
class CyclicBlock(Block):
    """From here on every move is drawn towards the posture of this moment; False ends it."""

    active: bool
