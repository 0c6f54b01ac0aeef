"""Solids as the collision library has them."""

from __future__ import annotations

from typing import Any

import coal
import numpy as np
import pinocchio as pin

from irlx.solids.placement import Placement
from irlx.solids.shape import Box, Capsule, Cone, Cylinder, Halfspace, Mesh, Point, Shape, Sphere


def _settle_boxes() -> None:
    """Ask for the distance of a turned box before anybody asks for another one.

    The first direction in which coal looks for the end of any box decides for the rest of the process whether
    all boxes are larger by a share of 1e-10: they are where one of its components is zero. What a run gives
    would depend on which runs were there before. With this direction boxes have their own size.
    """
    turned = pin.Quaternion(0.8, 0.4, 0.2, 0.4).normalized().toRotationMatrix()
    poses = coal.Transform3s.Identity(), coal.Transform3s(turned, np.array([5.0, 4.0, 3.0]))
    # A search begins along x of the first of two solids, so that the box must not be that.
    first, box = coal.Cylinder(1.0, 1.0), coal.Box(1.0, 1.0, 1.0)
    coal.distance(first, poses[0], box, poses[1], coal.DistanceRequest(), coal.DistanceResult())


_settle_boxes()


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
