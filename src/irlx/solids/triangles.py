"""A surface of triangles."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Triangles:
    """Vertices (V, 3) in m and faces (F, 3): indices of the corners, counterclockwise seen from outside."""

    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]

    @property
    def corners(self) -> NDArray[np.float64]:
        """Corners of every face, (F, 3, 3), m."""
        found: NDArray[np.float64] = self.vertices[self.faces]
        return found

    @cached_property
    def volume(self) -> float:
        """What the surface encloses, m3, negative where its faces look inwards.

        Sum of the tetrahedra between a point and the faces, a . (b x c) / 6; without meaning for an open one.
        """
        a, b, c = np.moveaxis(self.corners - self.vertices.mean(axis=0), 1, 0)
        return float(np.einsum("fi,fi->", a, np.cross(b, c)) / 6.0)

    @cached_property
    def open_edges(self) -> int:
        """Edges that do not have as many faces on one side as on the other; 0 for a closed surface.

        Every face runs along each of its edges in one direction, and a neighbour along the same edge in the
        other; an edge of faces that run the same way counts as open, too.
        """
        edges = self.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        forwards = np.where(edges[:, 0] < edges[:, 1], 1, -1)
        _, which = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)
        return int(np.count_nonzero(np.bincount(which.ravel(), weights=forwards)))
