"""The check of clearance: links stay off obstacles, and off each other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import ObstacleBlock
from irlx.promises import CLEARANCE, STARTED_INSIDE
from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.clearance.pairs import (
    Bodies,
    Meeting,
    Pair,
    Places,
    link_pairs,
    meetings,
    obstacle_pairs,
)
from irlx.verifier.clearance.search import NEAREST_WITHIN, capped_distances, near_rows
from irlx.verifier.clearance.spans import Spans, obstacle_spans, rows_in
from irlx.verifier.evidence import Evidence
from irlx.verifier.findings.finding import FAILED, NO_CASE, NOT_CHECKED, OK, Check
from irlx.verifier.rows import Rows

_Watch = tuple[Pair, tuple[tuple[int, int], ...]]
"""A pair, and the first and last row of every stretch in which it counts."""

_ALWAYS: tuple[tuple[int, int], ...] = ((0, np.iinfo(np.int64).max),)


class ClearanceChecks:
    """Distance of moving links from obstacles that are on, and of links from each other, in every row.

    At least the margin; of a motion that starts inside a margin, at least what it was there. Motions that
    pass into each other are one.
    """

    def __init__(self, evidence: Evidence) -> None:
        self._evidence = evidence
        self._tally = evidence.tally("clearance", "m")
        self._why_not, self._unknown = "", tuple[str, ...]()
        self._watched: list[_Watch] = []
        self._floors: dict[int, float] = {}
        self._inside: set[str] = set()
        self._counted = False
        scene, robot = evidence.scene, evidence.robot
        if scene is None or robot is None:
            asks = any(isinstance(record.block, ObstacleBlock) for record in evidence.outline.records)
            self._why_not = "no cell is known" if asks else ""
            return
        spans, self._unknown = obstacle_spans(evidence.outline, scene)
        try:
            self._watched = _watched(evidence, spans)
        except ValueError as cause:
            self._why_not = str(cause)
        if spans and not robot.solids:
            self._why_not = "the robot's links have no solids"

    def take(self, rows: Rows) -> None:
        """Add a portion."""
        robot = self._evidence.robot
        if not self._watched or robot is None:
            return
        numbers = np.arange(rows.first - 1, rows.first + len(rows))
        places = Places(robot, rows.postures, np.maximum(numbers, 0) * self._evidence.outline.header.dt)
        begins = self._begins(rows)
        asked: list[tuple[float, int, Pair, Meeting, Integers, Floats]] = []
        for index, (pair, spans) in enumerate(self._watched):
            counts = rows_in(spans, rows.rows)
            if not counts.any():
                self._floors.pop(index, None)
                continue
            self._counted = True
            met = meetings(pair, places)
            allowed = self._allowed(index, counts, begins, met)
            place = np.flatnonzero(counts) + 1
            for meeting in met:
                beyond = float(np.max(allowed[place - 1] - meeting.least[place], initial=-np.inf))
                asked.append((beyond, len(asked), pair, meeting, place, allowed[place - 1]))
        for beyond, _, pair, meeting, place, allowed in sorted(asked, reverse=True):
            if beyond <= min(CLEARANCE, self._tally.worst_rank + NEAREST_WITHIN):
                # No row comes near enough to matter, which most meetings are told by here.
                continue
            found = near_rows(meeting, place, allowed, CLEARANCE, self._tally.worst_rank)
            due = allowed[np.searchsorted(place, found.rows)]
            slack = np.where(due < pair.margin, STARTED_INSIDE, CLEARANCE)
            offends = ~(found.distances >= due - slack)
            rank = due - found.distances
            here = rows.first - 1 + found.rows
            self._tally.add(here, found.distances, due, offends, rank, pair=pair.name)

    def _begins(self, rows: Rows) -> NDArray[np.bool_]:
        """Which rows (R,) are the first of a motion that does not come out of another one."""
        found = np.zeros(len(rows), dtype=np.bool_)
        demands = self._evidence.demands
        for stretch in rows.stretches:
            demand = demands.get(stretch.block)
            if stretch.begins and not (demand is not None and demand.follows):
                found[stretch.part.start] = True
        return found

    def _allowed(
        self, index: int, counts: NDArray[np.bool_], begins: NDArray[np.bool_], met: list[Meeting]
    ) -> Floats:
        """What a pair has to keep in each row (R,), as far as it `counts` there (R,)."""
        pair = self._watched[index][0]
        goes_on = np.concatenate([[index in self._floors], counts[:-1]])
        starts = np.flatnonzero(counts & (begins | ~goes_on))
        # The row before row r is the r-th of the arrays that begin with the row before the portion.
        margin = np.full(len(starts), pair.margin)
        floors = np.minimum.reduce([margin, *(capped_distances(meeting, starts, margin) for meeting in met)])
        inside = ~(floors >= pair.margin - CLEARANCE)
        floors[~inside] = pair.margin
        if inside.any():
            self._inside.add(pair.name)
        known = np.append(self._floors.get(index, pair.margin), floors)
        allowed = known[np.searchsorted(starts, np.arange(len(counts)), side="right")]
        if counts[-1]:
            self._floors[index] = float(allowed[-1])
        else:
            self._floors.pop(index, None)
        return allowed

    def checks(self) -> list[Check]:
        """Clearance."""
        if self._unknown:
            words = f"the cell has no obstacle {', '.join(map(repr, self._unknown))}"
            worst, first = self._tally.worst, self._tally.first
            return [Check("clearance", FAILED, "m", worst, first, words)]
        if self._why_not:
            return [Check("clearance", NOT_CHECKED, "m", detail=self._why_not)]
        if self._inside:
            names = ", ".join(sorted(self._inside))
            self._tally.detail = f"a motion starts inside the margin and comes no nearer: {names}"
        found = self._tally.check()
        # Everything so far away that its distance is no number.
        return [replace(found, status=OK) if found.status == NO_CASE and self._counted else found]


def _watched(evidence: Evidence, spans: Spans) -> list[_Watch]:
    """Pairs that a stream keeps off each other, and in which rows. Raises ValueError: see `body_of`."""
    scene, robot = evidence.scene, evidence.robot
    if scene is None or robot is None:
        return []
    bodies = Bodies()
    found: list[_Watch] = [(pair, _ALWAYS) for pair in link_pairs(robot, scene, bodies)]
    for name, rows in spans.items():
        found += [(pair, rows) for pair in obstacle_pairs(robot, scene.obstacles[name], bodies)]
    return found
