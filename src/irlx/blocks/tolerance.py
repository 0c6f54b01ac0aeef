"""The clause by which a move frees coordinates of the tool within bands."""

from __future__ import annotations

from dataclasses import dataclass

from irlx.blocks.block import Origin

FREE_TURN = 3.141592653589793
"""A band of a turn from here on (rad) lets the tool turn without end."""


@dataclass(frozen=True)
class ToleranceClause:
    """How far the tool may stand off the programmed pose in one move; with the clause's place.

    `bands` (dx, dy, dz, da, db, dc): with the tool at Trans(x, y, z) Rz(c) Ry(b) Rx(a) in the frame of the
    programmed pose, |x| <= dx m and so on, |a| <= da rad about x and so on. 0 asks for the coordinate
    exactly; turns of `FREE_TURN` and more are without limit.
    """

    bands: tuple[float, float, float, float, float, float]
    origin: Origin
