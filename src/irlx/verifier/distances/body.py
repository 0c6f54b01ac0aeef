"""The bodies between which distances are measured."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from irlx.solids.mesh_file import MeshFileError, read_mesh
from irlx.solids.shape import Box, Capsule, Cone, Cylinder, Halfspace, Mesh, Point, Shape, Sphere
from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.distances.core import BoxCore, ConeCore, Core, CylinderCore
from irlx.verifier.distances.sphere_tree import SphereTree, sphere_tree


@dataclass(frozen=True, eq=False)
class ConvexBody:
    """All points at most `radius` (m) from a core."""

    core: Core
    radius: float = 0.0

    @property
    def centre(self) -> Floats:
        """Centre (3,) of a ball that holds the body, m."""
        return np.zeros(3)

    @property
    def reach(self) -> float:
        """Radius of that ball, m."""
        return self.core.reach + self.radius

    def height(self, directions: Floats) -> Floats:
        """Greatest coordinate (M,) of the body along unit directions (M, 3), m."""
        points = self.core.support(directions)
        return np.asarray(np.einsum("mi,mi->m", points, directions) + self.radius)

    def from_points(self, points: Floats) -> Floats:
        """At most the distance (M,) of points (M, 3) from the body."""
        return np.asarray(self.core.from_points(points) - self.radius)


@dataclass(frozen=True)
class HalfspaceBody:
    """All of z <= 0."""

    def from_points(self, points: Floats) -> Floats:
        """Distance (M,) of points (M, 3) from it, below 0 inside."""
        return np.array(points[:, 2])


@dataclass(frozen=True, eq=False)
class MeshBody:
    """What triangles with corners (T, 3, 3) enclose, m: the very triangles, not their hull."""

    corners: Floats
    radius: float = 0.0

    @cached_property
    def tree(self) -> SphereTree:
        """Spheres around the triangles."""
        return sphere_tree(self.corners)

    @cached_property
    def vertices(self) -> Floats:
        """All different corners (V, 3)."""
        return np.asarray(np.unique(self.corners.reshape(-1, 3), axis=0))

    @property
    def centre(self) -> Floats:
        """Centre (3,) of a ball that holds the body, m."""
        return np.asarray(self.tree.centres[0][0])

    @property
    def reach(self) -> float:
        """Radius of that ball, m."""
        return float(self.tree.radii[0][0])

    @cached_property
    def box(self) -> tuple[Floats, Floats]:
        """Least and greatest coordinates (3,)."""
        return self.vertices.min(axis=0), self.vertices.max(axis=0)

    def height(self, directions: Floats) -> Floats:
        """Greatest coordinate (M,) of the body along unit directions (M, 3), m."""
        size = max(1, 4_000_000 // len(self.vertices))
        parts = [
            (directions[i : i + size] @ self.vertices.T).max(axis=1) for i in range(0, len(directions), size)
        ]
        return np.concatenate([np.zeros(0), *parts])

    def from_points(self, points: Floats) -> Floats:
        """At most the distance (M,) of points (M, 3) from the body: that from its box."""
        low, high = self.box
        return np.asarray(np.linalg.norm(np.maximum(np.maximum(low - points, points - high), 0.0), axis=1))

    def winds_around(self, points: Floats) -> Floats:
        """How often (M,) the surface winds around points (M, 3): +-1 inside a closed one, 0 outside.

        Sum of the triangles' solid angles (van Oosterom and Strackee 1983) over 4 pi; points in no more than
        rounding from the surface get anything between.
        """
        found = np.zeros(len(points))
        near = np.flatnonzero(self.from_points(points) <= 0.0)
        size = max(1, 500_000 // len(self.corners))
        for part in (near[i : i + size] for i in range(0, len(near), size)):
            a, b, c = np.moveaxis(self.corners[None] - points[part][:, None, None], 2, 0)
            la, lb, lc = (np.linalg.norm(side, axis=2) for side in (a, b, c))
            volume = np.einsum("mti,mti->mt", a, np.cross(b, c))
            ab, bc, ca = (np.einsum("mti,mti->mt", p, q) for p, q in ((a, b), (b, c), (c, a)))
            angles = 2.0 * np.arctan2(volume, la * lb * lc + ab * lc + bc * la + ca * lb)
            found[part] = angles.sum(axis=1) / (4.0 * np.pi)
        return found


SolidBody = ConvexBody | MeshBody
Body = SolidBody | HalfspaceBody


def body_of(shape: Shape) -> Body:
    """Body of a shape, in its frame.

    Raises ValueError for lengths that are not above 0 and for what a mesh file cannot give.
    """
    match shape:
        case Point():
            return ConvexBody(BoxCore(np.zeros(3)))
        case Sphere(radius):
            _positive(radius)
            return ConvexBody(BoxCore(np.zeros(3)), radius)
        case Box(size):
            _positive(*size)
            return ConvexBody(BoxCore(0.5 * np.array(size)))
        case Capsule(radius, length):
            _positive(radius, length)
            return ConvexBody(BoxCore(np.array([0.0, 0.0, 0.5 * length])), radius)
        case Cylinder(radius, length):
            _positive(radius, length)
            return ConvexBody(CylinderCore(radius, 0.5 * length))
        case Cone(radius, length):
            _positive(radius, length)
            return ConvexBody(ConeCore(radius, 0.5 * length))
        case Halfspace():
            return HalfspaceBody()
        case Mesh():
            try:
                triangles = read_mesh(shape)
            except MeshFileError as cause:
                raise ValueError(f"the mesh {shape.file}: {cause}") from cause
            return mesh_body(triangles.vertices, triangles.faces)


def mesh_body(vertices: Floats, faces: Integers) -> MeshBody:
    """Body of a mesh: vertices (V, 3) m and corners of its faces as indices (F, 3). Raises ValueError."""
    corners = vertices[faces]
    if not len(corners) or not np.isfinite(corners).all():
        raise ValueError("a mesh needs triangles with finite corners")
    return MeshBody(corners)


def _positive(*lengths: float) -> None:
    if not all(0.0 < length < np.inf for length in lengths):
        raise ValueError(f"sizes of a shape have to be above 0, found {', '.join(map(str, lengths))}")
