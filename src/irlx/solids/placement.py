"""Where something lies in a frame."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin

Vector3 = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True)
class Placement:
    """Pose of a frame in another: position (m) and unit quaternion (x, y, z, w)."""

    position: Vector3 = (0.0, 0.0, 0.0)
    orientation: Quaternion = (0.0, 0.0, 0.0, 1.0)

    @classmethod
    def from_rpy(cls, xyz: Vector3, rpy: Vector3) -> Placement:
        """Placement of an origin: turns about the fixed x, y, z axes, in this order, rad."""
        (cx, sx), (cy, sy), (cz, sz) = ((cos(angle / 2), sin(angle / 2)) for angle in rpy)
        orientation = (
            sx * cy * cz - cx * sy * sz,
            cx * sy * cz + sx * cy * sz,
            cx * cy * sz - sx * sy * cz,
            cx * cy * cz + sx * sy * sz,
        )
        return cls(xyz, orientation)
