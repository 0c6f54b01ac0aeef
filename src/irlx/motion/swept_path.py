"""What all paths share whose position runs along one curve while the orientation turns in step with it."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import NDArray

from irlx.motion.pose_path import SHORTEST_WAY, SMALLEST_TURN, Poses
from irlx.motion.turn import HALF_TURN_MARGIN, Turning

Array = NDArray[np.float64]


class SweptPath(ABC):
    """A `PosePath` made of a curve and a turning, both functions of the share s / length in 0..1.

    Its parameter s is the arc length of the curve, or the angle of the turning where the curve is
    shorter than `SHORTEST_WAY`. A curve gives its length, its position by the share, and the first two
    derivatives of that.
    """

    end_position: Array
    end_rotation: Array

    @property
    @abstractmethod
    def turning(self) -> Turning:
        """How the orientation changes on the way."""

    @property
    @abstractmethod
    def translation(self) -> float:
        """Arc length of the position's curve, m."""

    @abstractmethod
    def _positions(self, share: Array) -> Array:
        """Positions (N, 3) m at the shares (N,); the end need not be exact."""

    @abstractmethod
    def _directions(self, share: Array) -> Array:
        """Derivative of the position by the share, (N, 3) m."""

    @abstractmethod
    def _bends(self, share: Array) -> Array:
        """Second derivative of the position by the share, (N, 3) m."""

    @property
    @abstractmethod
    def _peak_bend(self) -> float:
        """Largest length of `_bends`, m."""

    @property
    def angle(self) -> float:
        """Angle turned on the whole way, rad."""
        return self.turning.angle

    @property
    def is_pure_turn(self) -> bool:
        """Whether only the orientation changes."""
        return self.translation < SHORTEST_WAY

    @property
    def is_nothing(self) -> bool:
        """Whether neither position nor orientation changes."""
        return self.is_pure_turn and self.angle < SMALLEST_TURN

    @property
    def length(self) -> float:
        """Arc length, m, or the angle of a pure turn, rad."""
        return self.angle if self.is_pure_turn else self.translation

    @property
    def _scale(self) -> float:
        """Share per unit of the path parameter."""
        return 1.0 / self.length if self.length > 0.0 else 0.0

    @property
    def turn_rate(self) -> float:
        """Largest angle per unit of the path parameter: rad/m, or 1 for a turn on the spot about one axis."""
        return self.turning.peak_rate / self.length if self.length > 0.0 else 0.0

    @property
    def turn_bend(self) -> float:
        """Largest change of the angle per unit of s, per unit of s: rad/m2 or 1/rad."""
        return self.turning.peak_bend * self._scale**2

    @property
    def curvature(self) -> float:
        """Largest second derivative of the position by s, 1/m: 1/radius of an arc."""
        return self._peak_bend * self._scale**2

    @property
    def widest_turn(self) -> float:
        """Angle of the largest turn about one axis, rad."""
        return self.turning.widest

    @property
    def axis_is_defined(self) -> bool:
        """False for a turn of half a circle: every perpendicular axis would do."""
        return self.widest_turn < np.pi - HALF_TURN_MARGIN

    def poses(self, s: Array) -> Poses:
        """Poses at the parameters s (N,); the one at `length` is the end to the last bit."""
        share = self._shares(s)
        position = self._positions(share)
        position[share == 1.0] = self.end_position
        return Poses(position, self.turning.rotations(share))

    def derivatives(self, s: Array) -> tuple[Array, Array]:
        """d position/ds (N, 3) and angular rate per s (N, 3), rotation vector in the world frame."""
        share, scale = self._shares(s), self._scale
        return scale * self._directions(share), scale * self.turning.rates(share)

    def second_derivatives(self, s: Array) -> tuple[Array, Array]:
        """Derivatives by s of both parts of `derivatives`, each (N, 3)."""
        share, scale = self._shares(s), self._scale**2
        return scale * self._bends(share), scale * self.turning.bends(share)

    def _shares(self, s: Array) -> Array:
        """Shares (N,) of the whole way; 0 on a path that is nothing."""
        return np.asarray(s) / self.length if self.length > 0.0 else np.zeros(len(s))
