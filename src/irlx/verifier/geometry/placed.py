"""Where rows lie on curves that are run through one after another."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.geometry.bends import Stretches


@dataclass(frozen=True, eq=False)
class Placed:
    """Where rows (R,) lie on a chain.

    `position` m and `orientation` rad off it; `along` the way from its start, m; `leg` the number of the leg,
    whose end is the point of a blend nearest to the corner; `straight`: on a leg itself, not on a blend;
    `bend`: least curvature on the way from the row before, 1/m; `sharp`: a corner without a blend was passed
    on the way from the row before. `over`: by number of the row, the way from the row before where it leads
    from one part to others. `wanted` (R, 3, 3): the chain's own orientation there, told where not all
    turns count.
    """

    position: Floats
    orientation: Floats
    along: Floats
    leg: Integers
    straight: NDArray[np.bool_]
    bend: Floats
    sharp: NDArray[np.bool_]
    wanted: Floats | None = None
    over: dict[int, Stretches] = field(default_factory=dict)

    @classmethod
    def empty(cls, rows: int, all_turns: bool = True) -> Placed:
        """Room for R rows; without `all_turns` with room for orientations."""
        position, orientation, along, bend = np.zeros((4, rows))
        yes, no = np.ones(rows, dtype=np.bool_), np.zeros(rows, dtype=np.bool_)
        wanted = None if all_turns else np.zeros((rows, 3, 3))
        return cls(position, orientation, along, np.zeros(rows, dtype=np.int64), yes, bend, no, wanted)

    def first(self, rows: int) -> Placed:
        """The first of the rows."""
        return Placed(
            self.position[:rows],
            self.orientation[:rows],
            self.along[:rows],
            self.leg[:rows],
            self.straight[:rows],
            self.bend[:rows],
            self.sharp[:rows],
            None if self.wanted is None else self.wanted[:rows],
            {row: stretches for row, stretches in self.over.items() if row < rows},
        )
