"""Solids as the collision library has them."""

from __future__ import annotations

from typing import Any

import coal
import numpy as np
import pinocchio as pin

from irlx.solids.placement import Placement
from irlx.solids.shape import Box, Capsule, Cone, Cylinder, Halfspace, Mesh, Point, Shape, Sphere


def pose_of(placement: Placement) -> pin.SE3:
    """A placement as Pinocchio keeps it."""
    x, y, z, w = placement.orientation
    return pin.SE3(pin.Quaternion(w, x, y, z).normalized().toRotationMatrix(), np.array(placement.position))


def collision_shape(shape: Shape) -> Any:
    """Geometry of a shape; of a mesh its convex hull. Raises MeshFileError for a mesh that cannot be used."""
    match shape:
        case Point():
            return coal.Sphere(0.0)
        case Sphere(radius):
            return coal.Sphere(radius)
        case Box(size):
            return coal.Box(*size)
        case Cylinder(radius, length):
            return coal.Cylinder(radius, length)
        case Capsule(radius, length):
            return coal.Capsule(radius, length)
        case Cone(radius, length):
            return coal.Cone(radius, length)
        case Halfspace():
            return coal.Halfspace(np.array([0.0, 0.0, 1.0]), 0.0)
        case Mesh():
            return _hull(shape)


def bounding_radius(shape: Shape) -> float:
    """Radius (m) of the sphere about a shape's origin that contains it, infinite for a half-space."""
    match shape:
        case Point():
            return 0.0
        case Sphere(radius):
            return radius
        case Box(size):
            return float(np.linalg.norm(size)) / 2.0
        case Cylinder(radius, length) | Cone(radius, length):
            return float(np.hypot(radius, length / 2.0))
        case Capsule(radius, length):
            return radius + length / 2.0
        case Halfspace():
            return float("inf")
        case Mesh():
            from irlx.solids.mesh_file import read_mesh

            return float(np.max(np.linalg.norm(read_mesh(shape).vertices, axis=1)))


def _hull(mesh: Mesh) -> Any:
    from irlx.solids.hull import hull_of
    from irlx.solids.mesh_file import read_mesh

    hull = hull_of(read_mesh(mesh))
    points = coal.StdVec_Vec3s()
    for vertex in hull.vertices:
        points.append(vertex)
    faces = coal.StdVec_Triangle()
    for a, b, c in hull.faces.tolist():
        faces.append(coal.Triangle(a, b, c))
    return coal.Convex(points, faces)
