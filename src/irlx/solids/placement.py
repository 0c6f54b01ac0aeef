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

    def of(self, inner: Placement) -> Placement:
        """Where `inner`, a pose in this frame, lies in the frame that this one is placed in."""
        x, y, z = (a + b for a, b in zip(self.position, self.turned(inner.position), strict=True))
        return Placement((x, y, z), _product(self.orientation, inner.orientation))

    def turned(self, vector: Vector3) -> Vector3:
        """A vector of this frame in the directions of the frame that it is placed in."""
        x, y, z, w = self.orientation
        turned = _product(_product(self.orientation, (*vector, 0.0)), (-x, -y, -z, w))
        return turned[:3]


def _product(first: Quaternion, second: Quaternion) -> Quaternion:
    (ax, ay, az, aw), (bx, by, bz, bw) = first, second
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )
