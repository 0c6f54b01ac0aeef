"""What the pacer gives back."""

from __future__ import annotations

from dataclasses import dataclass

from irlx.blocks import Block
from irlx.pacing.rows import MotionRows


@dataclass(frozen=True)
class Executed:
    """A block, the tick whose row stood when it began, and the rows it became (None for none).

    A block whose motion has to stop on its way comes once for each part; `begins` tells the first one.
    """

    block: Block
    tick: int
    rows: MotionRows | None
    begins: bool = True
