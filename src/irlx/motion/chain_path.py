"""Pieces of paths one after another, run through without a stop."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from irlx.motion.pose_path import Poses
from irlx.motion.sections import Shape

Array = NDArray[np.float64]


class Piece(Protocol):
    """A piece of a chain, over its own arc length from 0 on, and the sections that its time law sees."""

    @property
    def length(self) -> float:
        """Arc length, m."""
        ...

    @property
    def shape(self) -> Shape:
        """Its sections."""
        ...

    def poses(self, s: Array) -> Poses:
        """Poses at s (N,)."""
        ...

    def derivatives(self, s: Array) -> tuple[Array, Array]:
        """First derivative by s of position and orientation, each (N, 3)."""
        ...

    def second_derivatives(self, s: Array) -> tuple[Array, Array]:
        """Second derivative by s of position and orientation, each (N, 3)."""
        ...


@dataclass(frozen=True)
class ChainPath:
    """One curve of pieces that join with the same tangent and curvature; s is the arc length of all.

    `end_position` (3,) m and `end_rotation` (3, 3) are what the last pose is exactly; `widest_turn` (rad) is
    the largest turn about one axis on the moves that were chained.
    """

    pieces: tuple[Piece, ...]
    end_position: Array
    end_rotation: Array
    widest_turn: float

    is_pure_turn = False
    is_nothing = False

    @cached_property
    def breaks(self) -> Array:
        """Values of s at which pieces meet, both ends included."""
        return np.concatenate([[0.0], np.cumsum([piece.length for piece in self.pieces])])

    @property
    def length(self) -> float:
        """Arc length, m."""
        return float(self.breaks[-1])

    @property
    def turn_rate(self) -> float:
        """Largest angle per m, rad/m."""
        return max(float(np.max(piece.shape.turn_rate)) for piece in self.pieces)

    @property
    def curvature(self) -> float:
        """Largest curvature, 1/m."""
        return max(float(np.max(piece.shape.curvature)) for piece in self.pieces)

    @property
    def turn_bend(self) -> float:
        """Largest change of the turn's rate, rad/m2."""
        return max(float(np.max(piece.shape.turn_bend)) for piece in self.pieces)

    def poses(self, s: Array) -> Poses:
        """Poses at s (N,); the one at `length` is the end to the last bit."""
        s = np.asarray(s)
        position, rotation = self._gathered(s, ((3,), (3, 3)), _pose_arrays)
        at_end = s >= self.length
        position[at_end], rotation[at_end] = self.end_position, self.end_rotation
        return Poses(position, rotation)

    def derivatives(self, s: Array) -> tuple[Array, Array]:
        """First derivative by s of position (N, 3) and of orientation (N, 3, rotation vector, world)."""
        return self._gathered(np.asarray(s), ((3,), (3,)), lambda piece, way: piece.derivatives(way))

    def second_derivatives(self, s: Array) -> tuple[Array, Array]:
        """Derivatives by s of the two parts of `derivatives`, each (N, 3)."""
        return self._gathered(np.asarray(s), ((3,), (3,)), lambda piece, way: piece.second_derivatives(way))

    def _gathered(
        self,
        s: Array,
        shapes: Sequence[tuple[int, ...]],
        values_of: Callable[[Piece, Array], tuple[Array, Array]],
    ) -> tuple[Array, Array]:
        """Two values at each s, from the piece that it lies on."""
        first, second = (np.empty((len(s), *shape)) for shape in shapes)
        k = np.clip(np.searchsorted(self.breaks, s, side="right") - 1, 0, len(self.pieces) - 1)
        for number in np.unique(k):
            here = k == number
            first[here], second[here] = values_of(self.pieces[number], s[here] - self.breaks[number])
        return first, second


def _pose_arrays(piece: Piece, s: Array) -> tuple[Array, Array]:
    poses = piece.poses(s)
    return poses.position, poses.rotation
