"""Distance between convex sets, bracketed: a separating plane from below, a pair of points from above."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.distances.depth import overlap_depth
from irlx.verifier.distances.placed import Convex, unit
from irlx.verifier.distances.simplex import nearest_to_origin

CLOSE = 2e-12
"""Width of the bracket at which the search ends, m, for bodies near each other."""

ROUGHLY = 0.5
"""Width of the bracket at which the search ends, as a share of how far a distance is beyond `enough`."""

_VAGUE = 1e-10
_MOST_STEPS = 200


class Gaps(NamedTuple):
    """Brackets of M distances, m; below 0 where the sets overlap, and as deep as they do.

    `lower` (M,) is the width of the empty slab between two parallel planes across `direction` (M, 3), a unit
    vector from the first set to the second: the distance is at least that, whatever became of the search.
    `upper` (M,) is the distance of two points of the sets, or minus the depth that was found.
    """

    lower: Floats
    upper: Floats
    direction: Floats


def separation(
    first: Convex,
    second: Convex,
    start: Floats | None = None,
    thorough: bool = True,
    enough: Floats | None = None,
) -> Gaps:
    """Distances between M pairs of convex sets by the algorithm of Gilbert, Johnson and Keerthi (1988).

    `start` (M, 3): directions from the first to the second to begin with, from centre to centre by default.
    Of a distance beyond `enough` (M,) a bracket is enough that is no wider than
    `ROUGHLY` times the excess.
    The set of differences of points of both has its point nearest to the origin at the distance: simplices of
    its support points close in on that. Overlapping sets are told by a simplex around the origin, and their
    depth by `overlap_depth`, `thorough` or not.
    """
    search = _Search(first, second, start, enough)
    while search.active.size and search.steps < _MOST_STEPS:
        search.step()
    return search.gaps(thorough)


class _Search:
    """All pairs at once; `active` holds the indices of those that are not done."""

    def __init__(self, first: Convex, second: Convex, start: Floats | None, enough: Floats | None) -> None:
        self.first, self.second, self._enough = first, second, enough
        outward = unit(second.centres - first.centres if start is None else start)
        outward[~outward.any(axis=1)] = (1.0, 0.0, 0.0)
        count = len(outward)
        corner = first.support(outward) - second.support(-outward)
        self.active: Integers = np.arange(count)
        self.steps = 0
        self.lower = -np.einsum("mi,mi->m", corner, outward)
        self.direction = outward
        self.upper = np.linalg.norm(corner, axis=1)
        self.overlaps: NDArray[np.bool_] = np.zeros(count, dtype=np.bool_)
        self._rough: NDArray[np.bool_] = np.zeros(count, dtype=np.bool_)
        # Of the active pairs: sets, simplex, nearest point.
        self._near = first, second
        self._point = corner
        self._corners = np.repeat(corner[:, None], 3, axis=1)
        self._held = np.zeros((count, 3), dtype=np.bool_)
        self._held[:, 0] = True

    def step(self) -> None:
        """Add a support point to each simplex and go to the nearest point of what that gives."""
        self.steps += 1
        size = np.linalg.norm(self._point, axis=1)
        outward = -np.divide(
            self._point, size[:, None], out=np.zeros_like(self._point), where=size[:, None] > 0.0
        )
        corner = self._near[0].support(outward) - self._near[1].support(-outward)
        lower = np.where(size > 0.0, -np.einsum("mi,mi->m", corner, outward), -np.inf)
        better = lower > self.lower[self.active]
        changed = self.active[better]
        self.lower[changed], self.direction[changed] = lower[better], outward[better]
        known = self.lower[self.active]
        near = size - known <= CLOSE + 4e-15 * np.abs(corner).max(axis=1)
        if self._enough is not None:
            rough = size - known <= ROUGHLY * (known - self._enough[self.active])
            self._rough[self.active[rough]] = True
            near |= rough
        going = np.flatnonzero(~near & (size > 0.0))
        found = nearest_to_origin(corner[going], self._corners[going], self._held[going])
        length = np.linalg.norm(found.points, axis=1)
        self.overlaps[self.active[going[found.inside]]] = True
        # Rounding ends it where no point comes nearer.
        on = ~found.inside & (length < size[going])
        kept = going[on]
        self.active = self.active[kept]
        self.upper[self.active] = length[on]
        self._keep(kept, corner[kept], found.points[on], found.needs[on])

    def _keep(self, kept: Integers, corner: Floats, points: Floats, needs: NDArray[np.bool_]) -> None:
        """The simplices that go on: the new corner in a place that is free, older ones that are needed."""
        corners = self._corners[kept]
        free = np.argmin(needs, axis=1)
        rows = np.arange(len(kept))
        corners[rows, free] = corner
        needs = needs.copy()
        needs[rows, free] = True
        self._corners, self._held, self._point = corners, needs, points
        self._near = self._near[0].take(kept), self._near[1].take(kept)

    def gaps(self, thorough: bool) -> Gaps:
        """What was found."""
        # Where a point of the differences is the origin itself the sets touch, or overlap.
        touch = self.overlaps | (self.upper <= CLOSE)
        # Points too near each other for their difference to have a direction: faces and edges have one.
        vague = ~touch & ~self._rough & (self.upper - self.lower > _VAGUE)
        for which, full in ((touch, thorough), (vague, False)):
            pairs = np.flatnonzero(which)
            if not pairs.size:
                continue
            sets = self.first.take(pairs), self.second.take(pairs)
            width, direction = overlap_depth(*sets, self.direction[pairs], full)
            self.lower[pairs], self.direction[pairs] = width, direction
        self.upper[touch] = self.lower[touch]
        return Gaps(self.lower, np.maximum(self.upper, self.lower), self.direction)
