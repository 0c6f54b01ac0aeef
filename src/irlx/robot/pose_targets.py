"""Demanded tool poses of many ticks or knots, as arrays and as Pinocchio keeps them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import overload

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class PoseTargets(Sequence[pin.SE3]):
    """N poses: `rotation` (N, 3, 3) and `position` (N, 3) m. Slices and chosen ones are of the same kind."""

    rotation: Array
    position: Array

    def __len__(self) -> int:
        return len(self.position)

    @overload
    def __getitem__(self, row: int) -> pin.SE3: ...
    @overload
    def __getitem__(self, row: slice) -> PoseTargets: ...
    def __getitem__(self, row: int | slice) -> pin.SE3 | PoseTargets:
        if isinstance(row, slice):
            return PoseTargets(self.rotation[row], self.position[row])
        return self._one_by_one[row]

    def chosen(self, rows: NDArray[np.intp]) -> PoseTargets:
        """The poses of some rows, by their numbers."""
        return PoseTargets(self.rotation[rows], self.position[rows])

    @cached_property
    def _one_by_one(self) -> list[pin.SE3]:
        return [pin.SE3(*pose) for pose in zip(self.rotation, self.position, strict=True)]
