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


class Clearance:
    """Pairs to be kept clear of each other in every tick of `dt` s."""

    def __init__(self, distances: Distances) -> None:
        self.distances = distances
        self.least = distances.margin + RESERVE

    def tick(self, q: Array, dt: float) -> TickClearance:
        """The floors of a tick of dt s that begins at posture q (n,)."""
        near = self.distances.near(q)
        least = self.least[near.pairs]
        share = min(dt / APPROACH_TIME, 1.0)
        above = np.maximum(near.distance - least, 0.0)
        floors = near.distance - share * above
        return TickClearance(self, q, near, floors)


class TickClearance:
    """Floors (P,) of the pairs of one tick, and the rows that they are at an iterate."""

    def __init__(self, clearance: Clearance, q: Array, near: Near, floors: Array) -> None:
        self._clearance = clearance
        self._q = q
        self.near = near
        self.floors = floors
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
        distances, least = self._clearance.distances, self._clearance.least
        there = distances.near(self._q + whole, np.maximum(distances.influence, least))
        floor = least.copy()
        floor[self.near.pairs] = self.floors
        short = there.distance < floor[there.pairs] - ALLOWANCE
        if not np.any(short):
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
        distances = self._clearance.distances
        q = self._q + whole
        self.near = distances.of(q, self.near.pairs)
        points = distances.jacobians(q, self.near)
        self._gradient = np.einsum("pi,pij->pj", self.near.away, points)
        self._looked_from = whole.copy()
        self._looks += 1
