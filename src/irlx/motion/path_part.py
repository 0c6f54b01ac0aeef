"""A part of a line or an arc: what two blends leave of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.motion.pose_path import PosePath, Poses
from irlx.motion.sections import Shape

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PathPart:
    """The path `whole` from its parameter `first` to `last`, counted from 0; `shape` is that of the part."""

    whole: PosePath
    first: float
    last: float
    shape: Shape

    @property
    def length(self) -> float:
        """Length in units of the whole path's parameter."""
        return self.last - self.first

    def poses(self, s: Array) -> Poses:
        """Poses at s (N,)."""
        return self.whole.poses(self._inside(s))

    def derivatives(self, s: Array) -> tuple[Array, Array]:
        """First derivative by s of position and orientation, each (N, 3)."""
        return self.whole.derivatives(self._inside(s))

    def second_derivatives(self, s: Array) -> tuple[Array, Array]:
        """Second derivative by s of position and orientation, each (N, 3)."""
        return self.whole.second_derivatives(self._inside(s))

    def _inside(self, s: Array) -> Array:
        return np.clip(self.first + s, self.first, self.last)
