"""Program bounds that mean the present posture, put exactly on it.

A program reads the posture in degrees and hands it back as a bound; the way through degrees may cost
the last bit, and a joint would stand outside a limit that was made from its own value.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import Block, JointRange, LimitClause, LimitKind, LimitSwitchBlock, MoveBlock

SAME_VALUE = 1e-12
"""Joint values closer than this (rad or m) are the same."""


def snapped(block: Block, q: NDArray[np.float64]) -> Block:
    """The block with position bounds within `SAME_VALUE` of the posture q (n,) put on it."""
    if isinstance(block, LimitSwitchBlock) and block.kind is LimitKind.POSITION and block.range is not None:
        return replace(block, range=_on(block.range, q))
    if isinstance(block, MoveBlock) and block.limits:
        return replace(block, limits=tuple(_clause_on(clause, q) for clause in block.limits))
    return block


def _clause_on(clause: LimitClause, q: NDArray[np.float64]) -> LimitClause:
    return replace(clause, range=_on(clause.range, q)) if clause.kind is LimitKind.POSITION else clause


def _on(bounds: JointRange, q: NDArray[np.float64]) -> JointRange:
    lower, upper = (
        tuple(
            float(value) if abs(value - bound) <= SAME_VALUE else bound
            for value, bound in zip(q, side, strict=True)
        )
        for side in (bounds.lower, bounds.upper)
    )
    return JointRange(lower, upper)
