"""Rows in which two bodies come near: what cannot matter is ruled out, the rest measured."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.clearance.pairs import Meeting
from irlx.verifier.distances.between import displacement, distances, slab
from irlx.verifier.distances.separation import Gaps

NEAREST_WITHIN = 1e-6
"""The smallest clearance that is told is at most this much above the true one, m."""

_APART = 32
"""Rows between those that are measured first."""


class Measured(NamedTuple):
    """Rows (M,) and the distances (M,) in them, m."""

    rows: Integers
    distances: Floats


def capped_distances(meeting: Meeting, rows: Integers, cap: Floats) -> Floats:
    """Distances (M,) in rows (M,) of a meeting, m, where they are below `cap` (M,), else `cap`."""
    found: Floats = cap.copy()
    near = np.flatnonzero(~(meeting.least[rows] >= cap))
    if near.size:
        found[near] = np.minimum(cap[near], _measured(meeting, rows[near]).upper)
    return found


def near_rows(meeting: Meeting, rows: Integers, allowed: Floats, tolerance: float, worst: float) -> Measured:
    """Those of `rows` (K,), in order, that matter, with their distances.

    A row matters where the distance may be below `allowed` (K,) by more than `tolerance`, or below it by more
    than `worst` (m, negative where all is well) and `NEAREST_WITHIN`. Others are left out, by three bounds
    from below: that of a ball around one body; the distance in a row near by less the way of any point of the
    body since; the empty slab between the bodies across the direction of that distance.
    """
    search = _Search(meeting, rows, allowed, tolerance, worst)
    left = search.mattering(np.arange(len(rows)), meeting.least[rows])
    if not left.size:
        return search.result()
    # The likeliest row first: it tells how much the others have to be nearer.
    search.measure(left[np.argmin((meeting.least[rows] - allowed)[left])][None])
    left = search.mattering(left, meeting.least[rows[left]])
    place = np.arange(len(left))
    anchors = left[np.minimum(place[::_APART] + _APART // 2, len(left) - 1)]
    if not anchors.size:
        return search.result()
    found = search.measure(anchors)
    anchor = place // _APART
    positions, rotations = meeting.at(rows[left])
    from_anchor = tuple(pose[anchor] for pose in meeting.at(rows[anchors]))
    moved = displacement(meeting.second, positions, rotations, *from_anchor)
    kept = search.mattering(place, found.lower[anchor] - moved, left)
    kept = kept[~np.isin(left[kept], anchors)]
    direction = found.direction[anchor[kept]]
    width = slab(meeting.first, meeting.second, positions[kept], rotations[kept], direction)
    on = search.mattering(np.arange(len(kept)), width, left[kept])
    if on.size:
        search.measure(left[kept[on]], direction[on])
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
        """Measure rows by their places."""
        found = _measured(self._meeting, self._rows[places], start)
        self._found.append((places, found.upper))
        beyond = self._allowed[places] - found.upper
        self._worst = max(self._worst, float(np.max(beyond)))
        return found

    def result(self) -> Measured:
        """All of it, every row once."""
        if not self._found:
            return Measured(np.zeros(0, dtype=np.int64), np.zeros(0))
        places, upper = (np.concatenate(part) for part in zip(*self._found, strict=True))
        places, once = np.unique(places, return_index=True)
        return Measured(self._rows[places], upper[once])


def _measured(meeting: Meeting, rows: Integers, start: Floats | None = None) -> Gaps:
    """Distances in rows; no number where the poses are none."""
    positions, rotations = meeting.at(rows)
    whole = np.asarray(np.isfinite(positions).all(axis=1) & np.isfinite(rotations).all(axis=(1, 2)))
    if whole.all():
        return distances(meeting.first, meeting.second, positions, rotations, start)
    found = Gaps(np.full(len(rows), np.nan), np.full(len(rows), np.nan), np.zeros((len(rows), 3)))
    parts = distances(meeting.first, meeting.second, positions[whole], rotations[whole])
    for all_of, part in zip(found, parts, strict=True):
        all_of[whole] = part
    return found
