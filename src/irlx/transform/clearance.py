"""Keeping clear: rows of a tick within which no pair of solids comes nearer than its margin.

A pair that is d0 away at the start of a tick of dt may lose the part dt/tau of what is left above its margin,

    d(q + S) >= floor,    floor = d0 - (d0 - margin) dt/tau,    d0 itself where that is inside the margin,

S the whole step of the tick. Distances are linearised at the iterates of Newton's method, until these hardly
move any more: a distance bends, but little over so short a way, and a row that stays the same lets the steps
settle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.scene.distances import Distances, Near

Array = NDArray[np.float64]
Numbers = NDArray[np.intp]

APPROACH_TIME = 0.1
"""Time constant tau (s) with which a pair comes near its margin."""

RESERVE = 2e-6
"""Distance (m) that ticks keep beside a margin: room for what `ALLOWANCE` lets them lose of it."""

ALLOWANCE = 1e-6
"""By how much (m) a solved tick may pass its floors."""

_BENDS = 1e-4
_MOST_LOOKS = 8


@dataclass(frozen=True)
class SideRows:
    """Inequalities matrix @ d >= lower of a step d: (P, n) and (P,)."""

    matrix: Array
    lower: Array

    def hold(self, d: Array) -> bool:
        """Whether a step keeps them, rounding allowed for."""
        return bool(np.all(self.matrix @ d >= self.lower - 1e-13))


@dataclass(frozen=True)
class TooNear:
    """The pair of a posture that is nearest to what it must keep: its number, and both distances (m)."""

    pair: int
    distance: float
    floor: float


class Clearance:
    """Pairs to be kept clear of each other."""

    def __init__(self, distances: Distances) -> None:
        self.distances = distances
        self._start: Array = np.zeros(0)
        self._at_start: Array = np.zeros(0)

    def tick(self, q: Array, dt: float, reserve: float = RESERVE) -> TickClearance | None:
        """The floors of a tick of dt s that begins at posture q (n,); None where everything is far.

        Where a step from there comes near something, `nears` tells.
        """
        return None if self.distances.far(q) else TickClearance(self.distances, q, dt, reserve)

    def watched_tick(self, q: Array, dt: float) -> TickClearance:
        """The same where something may come near, however far it is at the start of the tick."""
        return TickClearance(self.distances, q, dt, RESERVE)

    def nears(self, q: Array) -> bool:
        """Whether a tick that began without floors must not end at q (n,) unseen."""
        return not self.distances.far(q)

    def short(self, q: Array, start: Array) -> TooNear | None:
        """The pair of posture q (n,) that is nearer than it may be in a motion from `start` (n,); None: none.

        What was inside its margin at the start may stay as near as it was.
        """
        near = self._within(q)
        found = near.distance < self.floors(near.pairs, start) - ALLOWANCE
        return self.nearest(q, start) if np.any(found) else None

    def first_short(self, q: Array, start: Array) -> tuple[int, TooNear] | None:
        """The first of postures q (N, n) at which `short` finds a pair, and that pair, or None."""
        for row, posture in enumerate(q):
            found = None if self.distances.far(posture) else self.short(posture, start)
            if found is not None:
                return row, found
        return None

    def nearest(self, q: Array, start: Array) -> TooNear | None:
        """The pair with the least room above what it must keep at q (n,), of those within their influence."""
        near = self._within(q)
        if not len(near.pairs):
            return None
        floors = self.floors(near.pairs, start)
        k = int(np.argmin(near.distance - floors))
        return TooNear(int(near.pairs[k]), float(near.distance[k]), float(floors[k]))

    def _within(self, q: Array) -> Near:
        return self.distances.near(q, within(self.distances, RESERVE))

    def floors(self, pairs: Numbers, start: Array, reserve: float = 0.0) -> Array:
        """Distance (P,) that pairs must keep in a motion from posture `start` (n,): margin and reserve, m.

        What is nearer at the start may stay as near as it is.
        """
        least = self.distances.margin[pairs] + reserve
        if not np.array_equal(start, self._start):
            self._start, self._at_start = start.copy(), np.full(len(self.distances.pairs), np.nan)
        unknown = pairs[np.isnan(self._at_start[pairs])]
        if len(unknown):
            self._at_start[unknown] = self.distances.of(start, unknown).distance
        return np.asarray(np.minimum(least, self._at_start[pairs]))


def within(distances: Distances, reserve: float) -> Array | None:
    """From where on (K,), m, pairs may lack margin and reserve; None where influences contain that."""
    least = distances.margin + reserve
    return np.maximum(distances.influence, least) if np.any(least > distances.influence) else None


class TickClearance:
    """Floors (P,) of the pairs of one tick, and the rows that they are at an iterate."""

    def __init__(self, distances: Distances, q: Array, dt: float, reserve: float) -> None:
        self._distances = distances
        self._q = q
        self._least = distances.margin + reserve
        self._within = within(distances, reserve)
        self.near = distances.near(q)
        least = self._least[self.near.pairs]
        share = min(dt / APPROACH_TIME, 1.0)
        self.floors = self.near.distance - share * np.maximum(self.near.distance - least, 0.0)
        self._looked_from = np.zeros_like(q)
        self._gradient: Array | None = None
        self._looks = 0

    def rows(self, whole: Array) -> SideRows:
        """Rows of the Newton step at the iterate `whole` (n,), the step since the start of the tick."""
        moved = float(np.max(np.abs(whole - self._looked_from), initial=0.0))
        if self._gradient is None or (moved > _BENDS and self._looks < _MOST_LOOKS):
            self._look(whole)
        assert self._gradient is not None
        since = whole - self._looked_from
        return SideRows(self._gradient, self.floors - self.near.distance - self._gradient @ since)

    def kept(self, whole: Array) -> bool:
        """Whether distances at the end of a step keep their floors; where not, rows are made anew there.

        Pairs that were far at the start of the tick count with their margins.
        """
        distances = self._distances
        there = distances.near(self._q + whole, self._within)
        if not len(there.pairs):
            return True
        floor = self._least.copy()
        floor[self.near.pairs] = self.floors
        short = there.distance < floor[there.pairs] - ALLOWANCE
        if not np.count_nonzero(short):
            return True
        pairs = np.union1d(self.near.pairs, there.pairs[short])
        self.floors = floor[pairs]
        self.near = distances.of(self._q, pairs)
        self._gradient = None
        return False

    @property
    def exhausted(self) -> bool:
        """Whether looking again has not helped."""
        return self._looks >= _MOST_LOOKS

    def _look(self, whole: Array) -> None:
        distances = self._distances
        q = self._q + whole
        self.near = distances.of(q, self.near.pairs)
        self._gradient = distances.rates(q, self.near)
        self._looked_from = whole.copy()
        self._looks += 1
