"""Which triangles of a mesh are nearest, and how near: spheres rule out most, the rest is measured."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.distances.body import ConvexBody, MeshBody, SolidBody
from irlx.verifier.distances.placed import Convex, Placed, Resting, Triangles, backward, onward
from irlx.verifier.distances.separation import Gaps, separation

_MOST_PAIRS = 400_000
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
    below of their distance; `levels` of the trees they are nodes of."""

    rows: Integers
    ones: Integers
    others: Integers
    least: Floats
    levels: tuple[int, int]

    def take(self, which: Integers) -> _Near:
        """Those of the given indices."""
        return _Near(self.rows[which], self.ones[which], self.others[which], self.least[which], self.levels)


class _Pairs:
    """Parts of two bodies, in pairs: a convex body is one part, a mesh its triangles."""

    def __init__(self, first: SolidBody, second: SolidBody, positions: Floats, rotations: Floats) -> None:
        self._first, self._second = first, second
        self._positions, self._rotations = positions, rotations
        self._lasts = _depth(first) - 1, _depth(second) - 1

    def candidates(self) -> _Near | None:
        """Pairs of parts whose spheres are as near as any; None where that is too many at once."""
        front = self._front()
        self._upper = self._first_guess(front)
        while True:
            kept = np.flatnonzero(front.least <= self._upper[front.rows])
            front = front.take(kept)
            if front.levels == self._lasts:
                order = np.lexsort((front.least, front.rows))
                return front.take(order)
            if len(front.rows) > _MOST_PAIRS and len(self._positions) > 1:
                return None
            front = self._below(front)

    def _first_guess(self, front: _Near) -> Floats:
        """Distances (M,) of parts that are found by going down to the nearest spheres: at least the least."""
        while front.levels != self._lasts:
            front = self._below(front)
            order = np.lexsort((front.least, front.rows))
            front = front.take(order[np.flatnonzero(np.diff(front.rows[order], prepend=-1))])
        return separation(*self._sets(front), thorough=False).upper

    def _front(self) -> _Near:
        """Every row with both bodies as a whole."""
        rows: Integers = np.arange(len(self._positions))
        nodes = np.zeros(len(rows), dtype=np.int64)
        return _Near(rows, nodes, nodes, self._least(rows, nodes, nodes, (0, 0)), (0, 0))

    def _below(self, front: _Near) -> _Near:
        """The pairs one level down in the body that has the larger spheres."""
        one, other = front.levels
        larger = _radius(self._first, one) >= _radius(self._second, other)
        of_first = other == self._lasts[1] or (one < self._lasts[0] and larger)
        body, nodes = (self._first, front.ones) if of_first else (self._second, front.others)
        assert isinstance(body, MeshBody)
        parent, node = body.tree.below(one if of_first else other, nodes)
        rows = front.rows[parent]
        ones, others = (node, front.others[parent]) if of_first else (front.ones[parent], node)
        levels = (one + 1, other) if of_first else (one, other + 1)
        return _Near(rows, ones, others, self._least(rows, ones, others, levels), levels)

    def _least(self, rows: Integers, ones: Integers, others: Integers, levels: tuple[int, int]) -> Floats:
        """At most the distances (K,) of what is in two spheres."""
        one, one_radius = _spheres(self._first, levels[0], ones)
        other, other_radius = _spheres(self._second, levels[1], others)
        positions, rotations = self._positions[rows], self._rotations[rows]
        if isinstance(self._second, ConvexBody):
            apart = self._second.core.from_points(backward(rotations, one - positions)) - one_radius
        elif isinstance(self._first, ConvexBody):
            apart = self._first.core.from_points(positions + onward(rotations, other)) - other_radius
        else:
            between = positions + onward(rotations, other) - one
            apart = np.linalg.norm(between, axis=1) - one_radius - other_radius
        # Whatever rounding does: the nearest pair is never ruled out.
        return np.asarray(apart - 1e-13 * (1.0 + np.abs(apart) + one_radius + other_radius))

    def measured(self, near: _Near) -> Gaps:
        """Distances of rows, the likeliest pairs first; what a distance then rules out is not measured."""
        count = len(self._positions)
        lower, upper, direction = np.full(count, np.inf), np.full(count, np.inf), np.zeros((count, 3))
        portion = 1
        while len(near.rows):
            begins = np.searchsorted(near.rows, near.rows)
            now = np.arange(len(near.rows)) - begins < portion
            part = near.take(np.flatnonzero(now))
            found = separation(*self._sets(part), thorough=False)
            best = np.lexsort((found.upper, part.rows))
            firsts = best[np.flatnonzero(np.diff(part.rows[best], prepend=-1))]
            here = part.rows[firsts]
            nearer = found.upper[firsts] < upper[here]
            where, which = here[nearer], firsts[nearer]
            upper[where], direction[where] = found.upper[which], found.direction[which]
            np.minimum.at(lower, part.rows, found.lower)
            left = ~now & (near.least < upper[near.rows])
            near = near.take(np.flatnonzero(left))
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
        return near.take(np.flatnonzero(left))

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
