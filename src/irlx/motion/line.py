"""Straight lines and pure turns: constant direction, constant turn axis, both ends together."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from irlx.motion.swept_path import SweptPath
from irlx.motion.turn import Turn

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Line(SweptPath):
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
    def turning(self) -> Turn:
        """The one turn between the orientations at the ends."""
        return Turn(self.start_rotation, self.end_rotation)

    @cached_property
    def translation(self) -> float:
        """Distance between the ends, m."""
        return float(np.linalg.norm(self.end_position - self.start_position))

    def _positions(self, share: Array) -> Array:
        # Weighted ends, not start plus way: the last pose is then the target to the last bit.
        part = share[:, None]
        return (1.0 - part) * self.start_position + part * self.end_position

    def _directions(self, share: Array) -> Array:
        return np.tile(self.end_position - self.start_position, (len(share), 1))

    def _bends(self, share: Array) -> Array:
        return np.zeros((len(share), 3))

    @property
    def _peak_bend(self) -> float:
        return 0.0
