"""Interface of path geometry: tool poses over a path parameter."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SHORTEST_WAY = 1e-9
"""Ways shorter than this (m) do not move the tool's position."""

SMALLEST_TURN = 1e-9
"""Turns smaller than this (rad) do not change the tool's orientation."""


@dataclass(frozen=True)
class Poses:
    """N tool poses in the world: `position` (N, 3) m, `rotation` (N, 3, 3)."""

    position: Array
    rotation: Array

    def __len__(self) -> int:
        return int(self.position.shape[0])


class PosePath(Protocol):
    """A path of the tool over a parameter s from 0 to `length`.

    s is the arc length in m, or the angle in rad where the tool only turns. Largest values per unit of s,
    which speeds and accelerations are limited by: `turn_rate`, the angle turned; `curvature`, the change
    of the direction of travel; `turn_bend`, the change of the turn's rate.
    """

    @property
    def length(self) -> float:
        """Largest value of the path parameter, m or rad."""
        ...

    @property
    def turn_rate(self) -> float:
        """Largest angle turned per unit of the path parameter, rad/m or 1."""
        ...

    @property
    def curvature(self) -> float:
        """Largest second derivative of the position by s, 1/m (m/rad2 where the tool only turns)."""
        ...

    @property
    def turn_bend(self) -> float:
        """Largest second derivative of the orientation by s, rad/m2 or 1/rad."""
        ...

    @property
    def is_pure_turn(self) -> bool:
        """Whether only the orientation changes."""
        ...

    @property
    def is_nothing(self) -> bool:
        """Whether neither position nor orientation changes."""
        ...

    @property
    def widest_turn(self) -> float:
        """Angle of the largest turn about one axis on the path, rad, at most pi."""
        ...

    @property
    def end_position(self) -> Array:
        """Position at the end, (3,) m."""
        ...

    @property
    def end_rotation(self) -> Array:
        """Orientation at the end, (3, 3)."""
        ...

    def poses(self, s: Array) -> Poses:
        """Poses at the parameters s, shape (N,); the one at `length` is the end to the last bit."""
        ...

    def derivatives(self, s: Array) -> tuple[Array, Array]:
        """First derivative by s of position (N, 3) and of orientation (N, 3, rotation vector, world)."""
        ...

    def second_derivatives(self, s: Array) -> tuple[Array, Array]:
        """Derivatives by s of the two parts of `derivatives`, each (N, 3)."""
        ...
