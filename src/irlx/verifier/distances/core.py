"""Convex cores: what is left of a shape when a ball has been taken off all round."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from irlx.streams.joint_stream import Floats

_NO_LINES = np.zeros((0, 3))
_Z = np.array([[0.0, 0.0, 1.0]])


@dataclass(frozen=True, eq=False)
class BoxCore:
    """A box about the origin with half edges `half` (3,), m; zeros leave a rectangle, a segment, a point."""

    half: Floats

    @property
    def round(self) -> bool:
        """Whether it has faces or edges that bend."""
        return False

    @property
    def faces(self) -> Floats:
        """Normals (F, 3) of flat faces, one of each pair."""
        return np.eye(3) if np.any(self.half > 0.0) else _NO_LINES

    @property
    def edges(self) -> Floats:
        """Directions (E, 3) of straight edges."""
        return np.eye(3)[self.half > 0.0]

    @property
    def ridges(self) -> Floats:
        """Axes x, y, z and cosine 0 (K, 4) of the circles of normals of its edges: all across each."""
        return np.column_stack([self.edges, np.zeros(len(self.edges))])

    @property
    def reach(self) -> float:
        """Radius of the ball about the origin that holds it, m."""
        return float(np.linalg.norm(self.half))

    def support(self, directions: Floats) -> Floats:
        """Points (M, 3) furthest in directions (M, 3)."""
        return np.where(directions >= 0.0, self.half, -self.half)

    def from_points(self, points: Floats) -> Floats:
        """Distance (M,) of points (M, 3) from it; 0 inside."""
        return np.asarray(np.linalg.norm(np.maximum(np.abs(points) - self.half, 0.0), axis=1))


@dataclass(frozen=True, eq=False)
class CylinderCore:
    """A cylinder about the origin, axis z, of `radius` and half length `half`, m."""

    radius: float
    half: float

    @property
    def round(self) -> bool:
        """Whether it has faces or edges that bend."""
        return True

    @property
    def faces(self) -> Floats:
        """Normals (1, 3) of flat faces."""
        return _Z

    @property
    def edges(self) -> Floats:
        """Directions (1, 3) of straight edges, or of the axis."""
        return _Z

    @property
    def ridges(self) -> Floats:
        """Axis x, y, z and cosine (1, 4) of the circle of normals of its side."""
        return np.array([[0.0, 0.0, 1.0, 0.0]])

    @property
    def reach(self) -> float:
        """Radius of the ball about the origin that holds it, m."""
        return float(np.hypot(self.radius, self.half))

    def support(self, directions: Floats) -> Floats:
        """Points (M, 3) furthest in directions (M, 3)."""
        points = self.radius * _radial(directions)
        points[:, 2] = np.where(directions[:, 2] >= 0.0, self.half, -self.half)
        return points

    def from_points(self, points: Floats) -> Floats:
        """Distance (M,) of points (M, 3) from it; 0 inside."""
        out = np.hypot(points[:, 0], points[:, 1]) - self.radius
        above = np.abs(points[:, 2]) - self.half
        return np.asarray(np.hypot(np.maximum(out, 0.0), np.maximum(above, 0.0)))


@dataclass(frozen=True, eq=False)
class ConeCore:
    """A cone, axis z, its apex at +half, its base of `radius` at -half, m."""

    radius: float
    half: float

    @property
    def round(self) -> bool:
        """Whether it has faces or edges that bend."""
        return True

    @property
    def faces(self) -> Floats:
        """Normals (1, 3) of flat faces."""
        return _Z

    @property
    def edges(self) -> Floats:
        """Directions (1, 3) of straight edges, or of the axis."""
        return _Z

    @property
    def ridges(self) -> Floats:
        """Axis x, y, z and cosine (1, 4) of the circle of normals of its slant."""
        return np.array([[0.0, 0.0, 1.0, self.radius / np.hypot(self.radius, 2.0 * self.half)]])

    @property
    def reach(self) -> float:
        """Radius of the ball about the origin that holds it, m."""
        return float(np.hypot(self.radius, self.half))

    def support(self, directions: Floats) -> Floats:
        """Points (M, 3) furthest in directions (M, 3)."""
        out, up = np.hypot(directions[:, 0], directions[:, 1]), directions[:, 2]
        points = self.radius * _radial(directions)
        points[:, 2] = -self.half
        points[2.0 * self.half * up >= self.radius * out] = (0.0, 0.0, self.half)
        return points

    def from_points(self, points: Floats) -> Floats:
        """At most the distance (M,) of points (M, 3) from it: that from its base plane or its slant."""
        slant = np.hypot(self.radius, 2.0 * self.half)
        out, up = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
        side = (2.0 * self.half * out + self.radius * (up - self.half)) / slant
        return np.asarray(np.maximum(np.maximum(side, -self.half - up), 0.0))


Core = BoxCore | CylinderCore | ConeCore


def _radial(directions: Floats) -> Floats:
    """Unit vectors (M, 3) along the part of directions (M, 3) across the z axis, 0 where there is none."""
    found = np.zeros_like(directions)
    length = np.hypot(directions[:, 0], directions[:, 1])
    np.divide(directions[:, :2], length[:, None], out=found[:, :2], where=length[:, None] > 0.0)
    return found
