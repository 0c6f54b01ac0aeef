"""Interface of path geometry: tool poses over a path parameter."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Poses:
    """N tool poses in the world: `position` (N, 3) m, `rotation` (N, 3, 3)."""

    position: Array
    rotation: Array

    def __len__(self) -> int:
        return int(self.position.shape[0])


class PosePath(Protocol):
    """A path of the tool over a parameter s from 0 to `length`.

    s is the arc length in m, or the angle in rad where the tool only turns. `turn_rate` is the angle
    the tool turns per unit of s.
    """

    @property
    def length(self) -> float:
        """Largest value of the path parameter, m or rad."""
        ...

    @property
    def turn_rate(self) -> float:
        """Angle turned per unit of the path parameter, rad/m or 1."""
        ...

    def poses(self, s: Array) -> Poses:
        """Poses at the parameters s, shape (N,)."""
        ...

    def derivatives(self, s: Array) -> tuple[Array, Array]:
        """First derivative by s of position (N, 3) and of orientation (N, 3, rotation vector, world)."""
        ...
