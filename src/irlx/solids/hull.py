"""Convex hulls of surfaces."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from irlx.solids.mesh_file import MeshFileError
from irlx.solids.triangles import Triangles

_KEPT = 256


@lru_cache(maxsize=_KEPT)
def hull_of(triangles: Triangles) -> Triangles:
    """Convex hull of a surface's vertices; its corners are vertices of the surface, its faces look outwards.

    Built once for a surface, and `read_mesh` gives the same one for a file that stays as it is. Raises
    MeshFileError where the vertices lie in one plane.
    """
    points = np.asarray(triangles.vertices)
    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError) as cause:
        raise MeshFileError("its vertices lie in one plane, so it has no convex hull") from cause
    kept = hull.vertices
    place = np.full(len(points), -1)
    place[kept] = np.arange(len(kept))
    corners = points[hull.simplices]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inwards = np.einsum("fi,fi->f", normals, hull.equations[:, :3]) < 0.0
    faces = place[hull.simplices]
    faces[inwards] = faces[inwards, ::-1]
    return Triangles(points[kept], faces.astype(np.int64))
