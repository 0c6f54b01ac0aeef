"""Spheres around the triangles of a mesh, around groups of them, and so on: to rule out what is far."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from irlx.streams.joint_stream import Floats, Integers

BRANCHES = 4


@dataclass(frozen=True, eq=False)
class SphereTree:
    """Levels from the single sphere around all to one around each triangle.

    The node i of a level has the nodes 4 i .. 4 i + 3 of the next, as far as there are so many; `centres`
    (N, 3) m and `radii` (N,) of each level; node i of the last level is triangle `order[i]`.
    """

    centres: tuple[Floats, ...]
    radii: tuple[Floats, ...]
    order: Integers

    @property
    def depth(self) -> int:
        """Number of levels."""
        return len(self.radii)

    def below(self, level: int, nodes: Integers) -> tuple[Integers, Integers]:
        """Nodes of the level below those given (M,): which of them each belongs to, and its number."""
        children = nodes[:, None] * BRANCHES + np.arange(BRANCHES)
        parent, place = np.nonzero(children < len(self.radii[level + 1]))
        return parent, children[parent, place]


def sphere_tree(corners: Floats) -> SphereTree:
    """Tree over triangles with corners (T, 3, 3), neighbours in space put together. T > 0."""
    order = _along_a_curve(corners.mean(axis=1))
    sorted_corners = corners[order].reshape(-1, 3)
    centres, radii = [], []
    size = 1
    while True:
        starts = np.arange(0, len(sorted_corners), 3 * size)
        low, high = (side.reduceat(sorted_corners, starts) for side in (np.minimum, np.maximum))
        middle = 0.5 * (low + high)
        counts = np.diff(np.append(starts, len(sorted_corners)))
        away = np.linalg.norm(sorted_corners - np.repeat(middle, counts, axis=0), axis=1)
        centres.append(middle)
        # Rounded up: a sphere must never leave out a corner.
        radii.append(np.maximum.reduceat(away, starts) * (1.0 + 1e-14))
        if len(starts) == 1:
            return SphereTree(tuple(reversed(centres)), tuple(reversed(radii)), order)
        size *= BRANCHES


def _along_a_curve(points: Floats) -> Integers:
    """Order (T,) of points (T, 3) by Morton's curve: the bits of their coordinates interleaved."""
    low, high = points.min(axis=0), points.max(axis=0)
    extent = max(float((high - low).max()), 1e-300)
    cells = ((points - low) / extent * 1023.0).astype(np.int64)
    code = np.zeros(len(points), dtype=np.int64)
    for bit in range(10):
        for axis in range(3):
            code |= ((cells[:, axis] >> bit) & 1) << (3 * bit + axis)
    return np.argsort(code, kind="stable")
