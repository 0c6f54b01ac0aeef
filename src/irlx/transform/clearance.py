"""Keeping clear: rows of a tick within which no pair of solids comes nearer than its margin.

A pair that is d0 away at the start of a tick of dt may lose the part dt/tau of what is left above its margin,

    d(q + S) >= floor,    floor = d0 - (d0 - margin) dt/tau,

one that is inside its margin none of what it had when the motion began. S is the whole step of the tick.
Distances are linearised at the iterates of Newton's method, until these hardly move any more: a distance
bends, but little over so short a way, and a row that stays the same lets the steps settle.

From an obstacle that somebody sees while the program runs (`follow`) a pair inside its margin has to win the
part dt/tau of what it lacks; one outside it goes along with what the obstacle comes nearer in the tick, but
for the part dt/tau_seen of what is left above the margin.
"""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.scene.distances import Distances, Near

Array = NDArray[np.float64]
Numbers = NDArray[np.intp]

APPROACH_TIME = 0.1
"""Time constant tau (s) with which a pair comes near its margin."""

SEEN_TIME = 0.5
"""Time constant tau_seen (s) with which a pair gives way to an obstacle that is seen coming: its speed is
not known before, and joints need time to take it on."""

RESERVE = 2e-6
"""Distance (m) that ticks keep beside a margin: room for what `ALLOWANCE` lets them lose of it."""

ALLOWANCE = 1e-6
"""By how much (m) a solved tick may pass its floors."""

Closest = tuple[int, float] | None
"""Number of a pair, and its distance (m)."""

_BENDS = 1e-4
_NEAR_MARGIN = 0.01
_MOST_LOOKS = 8
_AHEAD = 16


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


@dataclass(frozen=True)
class Least:
    """Distances of all pairs (K,), m: what is `kept` between them, and what those nearer than that keep, the
    `lowest`. `reach` is that of `within`."""

    kept: Array
    lowest: Array
    reach: Array | None

    @classmethod
    def of(cls, distances: Distances, reserve: float, at_start: Near | None) -> Least:
        """Margins and a reserve (m); what is nearer `at_start` of a motion may stay as near as it is."""
        kept = distances.margin + reserve
        lowest = kept.copy()
        if at_start is not None:
            inside = at_start.pairs
            lowest[inside] = np.minimum(kept[inside], at_start.distance)
        return cls(kept, lowest, within(distances, lowest))


class Clearance:
    """Pairs to be kept clear of each other in a motion that begins at the time `begin` (s) of the run."""

    def __init__(self, distances: Distances, begin: float = 0.0) -> None:
        self.distances = distances
        self.begin = begin
        self._at_start: Near | None = None
        self._least: dict[float, Least] = {}
        self._start: Array = np.zeros(0)
        self._start_distance: Array = np.zeros(0)

    @property
    def moves(self) -> bool:
        """Whether any obstacle moves by itself."""
        return self.distances.moves

    def beginning(self, time: float) -> Clearance:
        """The same for a motion that begins at a `time` (s)."""
        return Clearance(self.distances, time)

    def after(self, elapsed: float) -> Distances:
        """The distances, obstacles placed where they are `elapsed` s after the begin of the motion."""
        self.distances.at_time(self.begin + elapsed)
        return self.distances

    def tick(
        self, q: Array, dt: float, elapsed: float = 0.0, reserve: float = RESERVE, paced: bool = True
    ) -> TickClearance | None:
        """The floors of a tick of dt s that begins at posture q (n,), `elapsed` s after the motion has begun.

        What is not `paced` may come down to its margin at once.
        None where everything is far; where a step from there comes near something, `nears` tells.
        """
        if self.after(elapsed).far(q):
            if elapsed == 0.0:
                self._begun(None)
            return None
        return self._tick(q, dt, elapsed, reserve, paced)

    def watched_tick(self, q: Array, dt: float, elapsed: float) -> TickClearance:
        """The same where something may come near, however far it is at the start of the tick."""
        return self._tick(q, dt, elapsed, RESERVE, True)

    def _tick(self, q: Array, dt: float, elapsed: float, reserve: float, paced: bool) -> TickClearance:
        distances = self.after(elapsed)
        if elapsed == 0.0:
            self._begun(distances.near(q, distances.margin + _NEAR_MARGIN))
        least = self._least.get(reserve)
        if least is None:
            least = self._least[reserve] = Least.of(distances, reserve, self._at_start)
        return TickClearance(distances, q, dt, least, self.begin + elapsed, paced)

    def _begun(self, near: Near | None) -> None:
        """Note what a motion has near its margins as it begins."""
        self._at_start = near
        self._least.clear()

    def following_tick(self, q: Array, base: Array, dt: float) -> TickClearance:
        """The floors of the first tick of dt s, in which the plan moves the joints by `base` (n,)."""
        self.distances.at_time(self.begin, before=True)
        least = self.distances.margin + RESERVE
        lowest, inside = least.copy(), self.distances.near(q, least)
        lowest[inside.pairs] = inside.distance
        kept = Least(least, lowest, within(self.distances, lowest))
        tick = TickClearance(self.distances, q, dt, kept, self.begin, before=True)
        tick.follow(base)
        return tick

    def begins_far(self, q: Array) -> bool:
        """Whether all is certainly far from posture q (n,) at the begin, obstacles where they were before."""
        self.distances.at_time(self.begin, before=True)
        return self.distances.far(q)

    def nears(self, q: Array, elapsed: float) -> bool:
        """Whether a tick that began without floors must not end at q (n,) unseen."""
        return not self.after(elapsed).far(q)

    def short(self, q: Array, start: Array, elapsed: float = 0.0) -> TooNear | None:
        """The pair of posture q (n,) that is nearer than it may be in a motion from `start` (n,); None: none.

        What was inside its margin at the start may stay as near as it was.
        """
        floors = self.floors(np.arange(len(self.distances.pairs)), start) if self.distances.moves else None
        self.after(elapsed)
        # No floor is above the margin.
        near = self.distances.near(q, self.distances.margin)
        if not len(near.pairs):
            return None
        least = self.floors(near.pairs, start) if floors is None else floors[near.pairs]
        room = near.distance - least
        if not np.any(room < -ALLOWANCE):
            return None
        k = int(np.argmin(room))
        return TooNear(int(near.pairs[k]), float(near.distance[k]), float(least[k]))

    def closest(self, q: Array, elapsed: float) -> Closest:
        """The pair with the least room above its margin at q (n,), `elapsed` s after the begin of the motion.

        None where all are farther away than they count.
        """
        distances = self.after(elapsed)
        if distances.far(q):
            return None
        near = distances.near(q)
        if not len(near.pairs):
            return None
        k = int((near.distance - distances.margin[near.pairs]).argmin())
        return int(near.pairs[k]), float(near.distance[k])

    def stays_clear(self, q: Array) -> bool:
        """Whether the way through postures q (N, n) surely keeps all margins, joints going straight from one
        to the next, where in each of them all pairs are beyond their influence."""
        room = self.distances.influence - self.distances.margin
        return self.distances.keeps_between(q, room)

    def inside_margin(self, q: Array) -> TooNear | None:
        """The pair of posture q (n,) that is deepest inside its margin; None where none is."""
        near = self.distances.near(q, self.distances.margin)
        if not len(near.pairs):
            return None
        margin = self.distances.margin[near.pairs]
        k = int(np.argmin(near.distance - margin))
        return TooNear(int(near.pairs[k]), float(near.distance[k]), float(margin[k]))

    def first_short(self, q: Array, start: Array, elapsed: Array | None = None) -> tuple[int, TooNear] | None:
        """The first of postures q (N, n), at times `elapsed` (N,), at which `short` finds a pair.

        With that pair; None where there is none.
        """
        times = np.zeros(len(q)) if elapsed is None else elapsed

        def found(row: int) -> TooNear | None:
            time = float(times[row])
            if self.distances.moves and self.after(time).far(q[row]):
                return None
            return self.short(q[row], start, time)

        return self._first(q, self.distances.margin, found)

    def _first(
        self, q: Array, within: Array, found: Callable[[int], TooNear | None]
    ) -> tuple[int, TooNear] | None:
        """The first of postures q (N, n) at which something is `found`. Not asked is where surely no pair is
        nearer than `within` (K,) m: a look at a posture also tells of those before and behind it."""
        distances, row, last, ahead = self.distances, 0, len(q) - 1, 1
        if distances.moves:
            looks = ((k, found(k)) for k in range(len(q)))
            return next(((k, there) for k, there in looks if there is not None), None)
        while row <= last:
            clear = distances.clear_rows(q[row : row + _AHEAD], within)
            row += clear
            if row > last:
                return None
            # A look tells of about as many rows before it as behind it.
            ahead = max(ahead, 3 * clear // 4)
            at = min(row + ahead, last)
            before, there = distances.known, found(at)
            row += distances.surely_clear(q[row:at], before, within)
            if row < at:
                ahead = (at - row) // 2
            elif there is not None:
                return row, there
            else:
                row += 1
        return None

    def untouched(self, q: Array) -> bool:
        """Whether all pairs are beyond their influence at all postures q (N, n), and none of them moves."""
        return not self.distances.moves and self.far_rows(q) == len(q)

    def far_rows(self, q: Array) -> int:
        """At how many of the first of postures q (N, n) all pairs are beyond their influence.

        Obstacles are where they were at the last look.
        """
        distances = self.distances
        reach = distances.influence

        def found(row: int) -> TooNear | None:
            near = distances.near(q[row], reach)
            return TooNear(int(near.pairs[0]), float(near.distance[0]), 0.0) if len(near.pairs) else None

        first = self._first(q, reach, found)
        return len(q) if first is None else first[0]

    def nearest(self, q: Array, start: Array, reserve: float = 0.0, elapsed: float = 0.0) -> TooNear | None:
        """The pair with the least room above what it must keep at q (n,), of those within their influence.

        That is its margin and a `reserve` (m), see `floors`; obstacles are where they are `elapsed` s after
        the begin of the motion.
        """
        self.after(elapsed)
        near = self._within(q)
        if not len(near.pairs):
            return None
        floors = self.floors(near.pairs, start, reserve)
        k = int(np.argmin(near.distance - floors))
        return TooNear(int(near.pairs[k]), float(near.distance[k]), float(floors[k]))

    def _within(self, q: Array) -> Near:
        return self.distances.near(q, within(self.distances, self.distances.margin + RESERVE))

    def floors(self, pairs: Numbers, start: Array, reserve: float = 0.0) -> Array:
        """Distance (P,) that pairs must keep in a motion from posture `start` (n,): margin and reserve, m.

        What is nearer at the start may stay as near as it is.
        """
        least = self.distances.margin[pairs] + reserve
        if not np.array_equal(start, self._start):
            self._start = start.copy()
            self._start_distance = np.full(len(self.distances.pairs), np.nan)
        unknown = pairs[np.isnan(self._start_distance[pairs])]
        if len(unknown):
            self._start_distance[unknown] = self.after(0.0).of(start, unknown).distance
        return np.asarray(np.minimum(least, self._start_distance[pairs]))


def within(distances: Distances, least: Array) -> Array | None:
    """From where on (K,), m, pairs may be nearer than `least` (K,); None where influences contain that."""
    return np.maximum(distances.influence, least) if np.any(least > distances.influence) else None


class TickClearance:
    """Floors (P,) of the pairs of one tick, and the rows that they are at an iterate."""

    def __init__(
        self,
        distances: Distances,
        q: Array,
        dt: float,
        least: Least,
        time: float,
        paced: bool = True,
        before: bool = False,
    ) -> None:
        """A tick of dt s from posture q (n,) at a `time` (s) of the run."""
        self._distances = distances
        self._end = time + dt
        distances.at_time(time, before)
        self._q = q
        self._dt = dt
        self._least = least
        self.near = distances.near(q)
        pairs, found = self.near.pairs, self.near.distance
        share = min(dt / APPROACH_TIME, 1.0) if paced else 1.0
        kept = least.kept[pairs]
        left = found - kept
        self.floors = np.where(left > 0.0, found - share * left, least.lowest[pairs])
        self._looked_from: Array | None = None
        self._gradient: Array | None = None
        self._looks = 0

    def follow(self, base: Array) -> None:
        """Raise the floors of obstacles that are seen; `base` (n,) is what the joints do of themselves."""
        pairs, before = self.near.pairs, self.near.distance
        seen = self._distances.seen[pairs]
        if not np.any(seen):
            return
        self._distances.at_time(self._end)
        here = self._distances.of(self._q, pairs).distance
        there = self._distances.of(self._q + base, pairs).distance
        room = before - self._least.kept[pairs]
        coming = np.maximum(before - here, 0.0)
        left = room * min(self._dt / SEEN_TIME, 1.0)
        slower = np.minimum(there + np.maximum(coming - left, 0.0), before - left)
        leaving = before - room * min(self._dt / APPROACH_TIME, 1.0)
        raised = np.where(room < 0.0, leaving, slower)
        self.floors = np.where(seen, np.maximum(self.floors, raised), self.floors)

    def rows(self, whole: Array) -> SideRows:
        """Rows of the Newton step at the iterate `whole` (n,), the step since the start of the tick."""
        if self._gradient is None or self._looked_from is None:
            self._gradient, self._looked_from = self._look(whole)
        elif self._looks < _MOST_LOOKS:
            moved = float(np.max(np.abs(whole - self._looked_from), initial=0.0))
            if moved > _BENDS:
                self._gradient, self._looked_from = self._look(whole)
        since = whole - self._looked_from
        return SideRows(self._gradient, self.floors - self.near.distance - self._gradient @ since)

    def kept(self, whole: Array) -> bool:
        """Whether distances at the end of a step keep their floors; where not, rows are made anew there.

        Pairs that were far at the start of the tick count with their margins.
        """
        distances = self._distances
        distances.at_time(self._end)
        there = distances.near(self._q + whole, self._least.reach)
        if not len(there.pairs):
            return True
        floor = self._least.lowest.copy()
        floor[self.near.pairs] = self.floors
        short = there.distance < floor[there.pairs] - ALLOWANCE
        if not np.count_nonzero(short):
            return True
        pairs = np.union1d(self.near.pairs, there.pairs[short])
        self.floors = floor[pairs]
        self.near = distances.of(self._q, pairs)
        self._gradient = None
        return False

    def stays_clear(self, whole: Array, further: Array) -> bool:
        """Whether what is near also stays clear where the step `whole` (n,) goes on by `further` (n,).

        To first order. Pairs inside their margins count where they come nearer still.
        """
        if not len(self.near.pairs):
            return True
        gradient, self._looked_from = self._look(whole)
        self._gradient = gradient
        loss = gradient @ further
        left = self.near.distance + loss - self._least.kept[self.near.pairs]
        return bool(np.all((left >= -ALLOWANCE) | (loss >= 0.0)))

    def at_margins(self) -> TickClearance:
        """The same tick where all may come as near as their margins at once, or stay as near as they are."""
        found = self.again()
        found.floors = np.minimum(found.floors, self._least.kept[self.near.pairs])
        return found

    def again(self) -> TickClearance:
        """The same tick, not looked at yet but for its start."""
        return self.without(np.zeros(0, dtype=np.intp))

    def without(self, pairs: Numbers) -> TickClearance:
        """The same tick in which these pairs (by number) may come as near as they like."""
        found = copy(self)
        kept, lowest = self._least.kept.copy(), self._least.lowest.copy()
        kept[pairs] = lowest[pairs] = -np.inf
        found._least = Least(kept, lowest, self._least.reach)
        stay = ~np.isin(self.near.pairs, pairs)
        found.near, found.floors = self.near.chosen(stay), self.floors[stay]
        found._gradient, found._looks = None, 0
        return found

    @property
    def exhausted(self) -> bool:
        """Whether looking again has not helped."""
        return self._looks >= _MOST_LOOKS

    def _look(self, whole: Array) -> tuple[Array, Array]:
        """Distances at an iterate; how they grow with the joints (P, n), and the iterate."""
        distances = self._distances
        distances.at_time(self._end)
        q = self._q + whole
        self.near = distances.of(q, self.near.pairs)
        self._looks += 1
        return distances.rates(q, self.near), whole.copy()
