"""Which triangles of a mesh are nearest, and how near: spheres rule out most, the rest is measured."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.distances.body import ConvexBody, MeshBody, SolidBody
from irlx.verifier.distances.placed import Convex, Placed, Resting, Triangles, onward
from irlx.verifier.distances.separation import Gaps, separation

_MOST_PAIRS = 1_000_000
"""Pairs of spheres looked at together; where there would be more, rows are taken in halves."""


def nearest_triangles(first: SolidBody, second: SolidBody, positions: Floats, rotations: Floats) -> Gaps:
    """Brackets of the distances (M,) between the surfaces of two bodies, one of which at least is a mesh.

    A convex body counts as solid, without its radius; `first` rests, `second` is at positions (M, 3),
    rotations (M, 3, 3).
    """
    if not len(positions):
        return Gaps(np.zeros(0), np.zeros(0), np.zeros((0, 3)))
    pairs = _Pairs(first, second, positions, rotations)
    near = pairs.candidates()
    if near is None:
        half = len(positions) // 2
        parts = [
            nearest_triangles(first, second, positions[part], rotations[part])
            for part in (slice(None, half), slice(half, None))
        ]
        return Gaps(*(np.concatenate(sides) for sides in zip(*parts, strict=True)))
    return pairs.measured(near)


class _Near(NamedTuple):
    """Pairs (K,) that may be nearest: their row, part of the first and of the second body, and a bound from
    below of their distance; in order of rows, the least bound first."""

    rows: Integers
    ones: Integers
    others: Integers
    least: Floats


class _Pairs:
    """Parts of two bodies, in pairs: a convex body is one part, a mesh its triangles."""

    def __init__(self, first: SolidBody, second: SolidBody, positions: Floats, rotations: Floats) -> None:
        self._first, self._second = first, second
        self._positions, self._rotations = positions, rotations
        self._upper = np.full(len(positions), np.inf)

    def candidates(self) -> _Near | None:
        """Pairs of parts whose spheres are as near as any; None where that is too many at once."""
        rows = np.arange(len(self._positions))
        ones = others = np.zeros(len(rows), dtype=np.int64)
        levels = [0, 0]
        lasts = [_depth(self._first) - 1, _depth(self._second) - 1]
        while True:
            least, most = self._bounds(rows, ones, others, levels)
            np.minimum.at(self._upper, rows, most)
            kept = np.flatnonzero(least <= self._upper[rows])
            rows, ones, others, least = rows[kept], ones[kept], others[kept], least[kept]
            if levels == lasts:
                order = np.lexsort((least, rows))
                return _Near(rows[order], ones[order], others[order], least[order])
            if len(rows) > _MOST_PAIRS and len(self._positions) > 1:
                return None
            # The body with the larger spheres is taken apart.
            sizes = [_radius(self._first, levels[0]), _radius(self._second, levels[1])]
            side = 0 if levels[1] == lasts[1] or (levels[0] < lasts[0] and sizes[0] >= sizes[1]) else 1
            body = (self._first, self._second)[side]
            assert isinstance(body, MeshBody)
            parent, node = body.tree.below(levels[side], (ones, others)[side])
            rows = rows[parent]
            ones, others = (node, others[parent]) if side == 0 else (ones[parent], node)
            levels[side] += 1

    def _bounds(
        self, rows: Integers, ones: Integers, others: Integers, levels: list[int]
    ) -> tuple[Floats, Floats]:
        """Distances of parts in two spheres: at least, at most."""
        one, one_radius = _spheres(self._first, levels[0], ones)
        other, other_radius = _spheres(self._second, levels[1], others)
        placed = self._positions[rows] + onward(self._rotations[rows], other)
        apart = np.linalg.norm(placed - one, axis=1)
        # Whatever rounding does: a nearest pair is never ruled out.
        slack = 1e-13 * (1.0 + apart)
        around = one_radius + other_radius
        if isinstance(self._first, ConvexBody) and isinstance(self._second, MeshBody):
            least = self._first.core.from_points(placed) - other_radius
        else:
            least = apart - around
        return least - slack, apart + around + slack

    def measured(self, near: _Near) -> Gaps:
        """Distances of rows, the likeliest pairs first; what a distance then rules out is not measured."""
        count = len(self._positions)
        lower, upper, direction = np.full(count, np.inf), np.full(count, np.inf), np.zeros((count, 3))
        portion = 1
        while len(near.rows):
            begins = np.searchsorted(near.rows, near.rows)
            now = np.arange(len(near.rows)) - begins < portion
            part = _Near(*(values[now] for values in near))
            found = separation(*self._sets(part))
            self._upper[:] = np.minimum(self._upper, upper)
            best = np.lexsort((found.upper, part.rows))
            firsts = best[np.flatnonzero(np.diff(part.rows[best], prepend=-1))]
            here = part.rows[firsts]
            nearer = found.upper[firsts] < upper[here]
            where, which = here[nearer], firsts[nearer]
            upper[where], direction[where] = found.upper[which], found.direction[which]
            np.minimum.at(lower, part.rows, found.lower)
            left = ~now & (near.least < upper[near.rows])
            near = _Near(*(values[left] for values in near))
            if len(near.rows):
                near = self._beyond(near, direction, upper)
            portion *= 4
        return Gaps(np.minimum(lower, upper), upper, direction)

    def _beyond(self, near: _Near, direction: Floats, upper: Floats) -> _Near:
        """Without pairs that a slab across the direction of the nearest one so far shows to be no nearer."""
        first, second = self._sets(near)
        across = direction[near.rows]
        corner = first.support(across) - second.support(-across)
        width = -np.einsum("mi,mi->m", corner, across)
        left = width < upper[near.rows]
        return _Near(*(values[left] for values in near))

    def _sets(self, near: _Near) -> tuple[Convex, Convex]:
        """The parts of pairs as convex sets in the frame of the first body."""
        positions, rotations = self._positions[near.rows], self._rotations[near.rows]
        first: Convex
        second: Convex
        if isinstance(self._first, MeshBody):
            first = Triangles(_corners(self._first, near.ones))
        else:
            first = Resting(self._first.core, len(near.rows))
        if isinstance(self._second, MeshBody):
            corners = _corners(self._second, near.others)
            second = Triangles(positions[:, None] + np.einsum("mij,mkj->mki", rotations, corners))
        else:
            second = Placed(self._second.core, positions, rotations)
        return first, second


def _depth(body: SolidBody) -> int:
    return body.tree.depth if isinstance(body, MeshBody) else 1


def _radius(body: SolidBody, level: int) -> float:
    return float(body.tree.radii[level].max()) if isinstance(body, MeshBody) else body.core.reach


def _spheres(body: SolidBody, level: int, nodes: Integers) -> tuple[Floats, Floats]:
    """Centres (K, 3) and radii (K,) of nodes."""
    if isinstance(body, MeshBody):
        return body.tree.centres[level][nodes], body.tree.radii[level][nodes]
    return np.zeros((len(nodes), 3)), np.full(len(nodes), body.core.reach)


def _corners(body: MeshBody, nodes: Integers) -> Floats:
    """Corners (K, 3, 3) of the triangles of nodes of the last level."""
    return np.asarray(body.corners[body.tree.order[nodes]])
