"""Rows in which two bodies come near: what cannot matter is ruled out, the rest measured."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.clearance.pairs import Meeting
from irlx.verifier.distances.between import displacement, distances, slab
from irlx.verifier.distances.body import HalfspaceBody
from irlx.verifier.distances.placed import unit
from irlx.verifier.distances.separation import Gaps

NEAREST_WITHIN = 1e-6
"""The smallest clearance that is told is at most this much above the true one, m."""

_APART = (512, 64, 8)
"""Rows between those that are measured first, and between those of what that leaves."""

_SLABS_APART = 64
"""Rows between those in which slabs are looked for before anything is measured."""


class Measured(NamedTuple):
    """Rows (M,) and the distances (M,) in them, m."""

    rows: Integers
    distances: Floats


def capped_distances(meeting: Meeting, rows: Integers, cap: Floats) -> Floats:
    """Distances (M,) in rows (M,) of a meeting, m, where they are below `cap` (M,), else `cap`."""
    found: Floats = cap.copy()
    near = np.flatnonzero(~(meeting.least[rows] >= cap))
    if near.size:
        found[near] = np.minimum(cap[near], _measured(meeting, rows[near], cap[near]).upper)
    return found


def near_rows(meeting: Meeting, rows: Integers, allowed: Floats, tolerance: float, worst: float) -> Measured:
    """Those of `rows` (K,), in order, that matter, with their distances.

    A row matters where the distance may be below `allowed` (K,) by more than `tolerance`, or below it by more
    than `worst` (m, negative where all is well) and `NEAREST_WITHIN`. Others are left out, by bounds from
    below: that of a ball around one body; what a row near by has, less the way of any point of the body
    since, first the empty slab across the line between the centres, then the distance; the empty slab across
    the direction of that distance. Rows near by are few at first, and more among those that this leaves.
    """
    search = _Search(meeting, rows, allowed, tolerance, worst)
    left = search.mattering(np.arange(len(rows)), meeting.least[rows])
    left = search.between_centres(left)
    direction = np.zeros((0, 3))
    for apart in _APART:
        left, direction = search.ruled_out(left, apart)
    if left.size:
        search.measure(left, direction)
    return search.result()


class _Search:
    """What was measured so far."""

    def __init__(
        self, meeting: Meeting, rows: Integers, allowed: Floats, tolerance: float, worst: float
    ) -> None:
        self._meeting, self._rows, self._allowed = meeting, rows, allowed
        self._tolerance, self._worst = tolerance, worst
        self._found: list[tuple[Integers, Floats]] = []

    def mattering(self, which: Integers, least: Floats, places: Integers | None = None) -> Integers:
        """Those of `which` (M,) whose distance, at least `least` (M,), may matter; `places` (M,) of them in
        the rows, by default they are these."""
        allowed = self._allowed[which if places is None else places]
        # Written so that what is no number matters.
        keeps = (least >= allowed - self._tolerance) & (allowed - least <= self._worst + NEAREST_WITHIN)
        return which[np.logical_not(keeps)]

    def measure(self, places: Integers, start: Floats | None = None) -> Gaps:
        """Measure rows by their places, roughly what cannot matter."""
        enough = self._allowed[places] - min(self._tolerance, self._worst)
        found = _measured(self._meeting, self._rows[places], enough, start)
        self._found.append((places, found.upper))
        beyond = self._allowed[places] - found.upper
        self._worst = max(self._worst, float(np.max(beyond)))
        return found

    def between_centres(self, left: Integers) -> Integers:
        """Those of rows at places `left` (K,) that may still matter behind slabs between the centres."""
        if not left.size or isinstance(self._meeting.first, HalfspaceBody):
            return left
        anchor, anchors = _every(len(left), _SLABS_APART)
        towards = unit(self._meeting.centres[self._rows[left[anchors]]] - self._meeting.first.centre)
        width = self._slabs(left[anchors], towards)
        return left[self._near(left, anchor, left[anchors], width)]

    def ruled_out(self, left: Integers, apart: int) -> tuple[Integers, Floats]:
        """Those of rows at places `left` (K,) that may still matter when every so many of them is measured,
        and directions (L, 3) across which both bodies lie in the row next to each that is."""
        if not left.size:
            return left, np.zeros((0, 3))
        anchor, anchors = _every(len(left), apart)
        # The likeliest row with them: it tells how much the others have to be nearer.
        likeliest = np.argmin(self._meeting.least[self._rows[left]] - self._allowed[left])
        measured = np.append(anchors, likeliest)
        found = self.measure(left[measured])
        kept = self._near(left, anchor, left[anchors], found.lower[:-1])
        kept = kept[~np.isin(kept, measured)]
        direction = found.direction[anchor[kept]]
        on = self.mattering(np.arange(len(kept)), self._slabs(left[kept], direction), left[kept])
        return left[kept[on]], direction[on]

    def _near(self, left: Integers, anchor: Integers, anchors: Integers, lower: Floats) -> Integers:
        """Which of K rows at places `left` may still matter, the distance at `anchors` (A,) being at least
        `lower` (A,): it is less by the way since at most. `anchor` (K,) tells which is near each."""
        rows, meeting = self._rows, self._meeting
        here, there = meeting.at(rows[left]), meeting.at(rows[anchors])
        moved = displacement(meeting.second, *here, *(pose[anchor] for pose in there))
        return self.mattering(np.arange(len(left)), lower[anchor] - moved, left)

    def _slabs(self, places: Integers, directions: Floats) -> Floats:
        """Widths (M,) of the empty slabs across unit directions (M, 3); of those that are none no bound."""
        meeting = self._meeting
        width = slab(meeting.first, meeting.second, *meeting.at(self._rows[places]), directions)
        return np.where(directions.any(axis=1), width, -np.inf)

    def result(self) -> Measured:
        """All of it, every row once."""
        if not self._found:
            return Measured(np.zeros(0, dtype=np.int64), np.zeros(0))
        places, upper = (np.concatenate(part) for part in zip(*self._found, strict=True))
        places, once = np.unique(places, return_index=True)
        return Measured(self._rows[places], upper[once])


def _every(count: int, apart: int) -> tuple[Integers, Integers]:
    """Which one (count,) of some places is near each, and these places, every so many of `count`."""
    place = np.arange(count)
    return place // apart, np.minimum(place[::apart] + apart // 2, count - 1)


def _measured(meeting: Meeting, rows: Integers, enough: Floats, start: Floats | None = None) -> Gaps:
    """Distances in rows, roughly those beyond `enough` (M,); no number where the poses are none."""
    positions, rotations = meeting.at(rows)
    whole = np.asarray(np.isfinite(positions).all(axis=1) & np.isfinite(rotations).all(axis=(1, 2)))
    if whole.all():
        return distances(meeting.first, meeting.second, positions, rotations, start, enough)
    found = Gaps(np.full(len(rows), np.nan), np.full(len(rows), np.nan), np.zeros((len(rows), 3)))
    parts = distances(meeting.first, meeting.second, positions[whole], rotations[whole], enough=enough[whole])
    for all_of, part in zip(found, parts, strict=True):
        all_of[whole] = part
    return found
