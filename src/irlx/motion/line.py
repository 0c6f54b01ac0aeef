"""Straight lines and pure turns: constant direction, constant turn axis, both ends together."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.motion.pose_path import Poses

Array = NDArray[np.float64]

SHORTEST_LINE = 1e-9
"""Lines shorter than this (m) do not move the tool's position."""

SMALLEST_TURN = 1e-9
"""Turns smaller than this (rad) do not change the tool's orientation."""

HALF_TURN_MARGIN = 1e-6
"""A turn this close (rad) to half a turn has no defined axis."""


@dataclass(frozen=True)
class Line:
    """Line from one pose to another, the orientation turning about one fixed axis (slerp).

    position(s) = p0 + s/length (p1 - p0), rotation(s) = R0 exp(s/length theta), theta the rotation
    vector from R0 to R1 in the tool frame at the start. Positions (3,) in m, rotations (3, 3).
    A line without translation is a pure turn, its parameter the angle.
    """

    start_position: Array
    start_rotation: Array
    end_position: Array
    end_rotation: Array

    @cached_property
    def _turn(self) -> Array:
        relative = Rotation.from_matrix(self.start_rotation.T @ self.end_rotation)
        return np.asarray(relative.as_rotvec())

    @cached_property
    def translation(self) -> float:
        """Distance between the ends, m."""
        return float(np.linalg.norm(self.end_position - self.start_position))

    @cached_property
    def angle(self) -> float:
        """Angle between the orientations at the ends, rad, at most pi."""
        return float(np.linalg.norm(self._turn))

    @property
    def is_pure_turn(self) -> bool:
        """Whether only the orientation changes."""
        return self.translation < SHORTEST_LINE

    @property
    def is_nothing(self) -> bool:
        """Whether neither position nor orientation changes."""
        return self.is_pure_turn and self.angle < SMALLEST_TURN

    @property
    def length(self) -> float:
        """Arc length, m, or the angle of a pure turn, rad."""
        return self.angle if self.is_pure_turn else self.translation

    @property
    def turn_rate(self) -> float:
        """Angle per unit of the path parameter: rad/m, or 1 for a pure turn."""
        return self.angle / self.length if self.length > 0.0 else 0.0

    @property
    def axis_is_defined(self) -> bool:
        """False for a turn of half a circle: every perpendicular axis would do."""
        return self.angle < np.pi - HALF_TURN_MARGIN

    def poses(self, s: Array) -> Poses:
        """Poses at the parameters s (N,)."""
        share = np.asarray(s)[:, None] / self.length if self.length > 0.0 else np.zeros((len(s), 1))
        # Weighted ends, not start plus way: the last pose is then the target to the last bit.
        position = (1.0 - share) * self.start_position + share * self.end_position
        turned = Rotation.from_rotvec(share * self._turn).as_matrix()
        rotation = self.start_rotation @ turned
        rotation[share[:, 0] == 1.0] = self.end_rotation
        return Poses(position, rotation)

    def derivatives(self, s: Array) -> tuple[Array, Array]:
        """d position/ds (N, 3) and angular rate per s (N, 3), rotation vector in the world frame."""
        count = len(s)
        scale = 1.0 / self.length if self.length > 0.0 else 0.0
        along = scale * (self.end_position - self.start_position)
        axis = scale * (self.start_rotation @ self._turn)
        return np.tile(along, (count, 1)), np.tile(axis, (count, 1))
