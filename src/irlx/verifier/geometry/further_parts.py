"""Which part of a chain a row lies on, where a tick may have led over several of them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from irlx.promises import PATH_POSITION
from irlx.streams.joint_stream import Floats
from irlx.verifier.geometry.allowance import Allowance
from irlx.verifier.geometry.chain_parts import ChainParts, On, Part
from irlx.verifier.geometry.corners import distance_taken
from irlx.verifier.geometry.curves import Pose


class Reached(NamedTuple):
    """Where the last row lies: on a part, at a place of it, and how far along the whole way, m."""

    part: Part
    at: float
    along: float


class Reachable(NamedTuple):
    """The parts of a chain as seen from the last row, and how far from there the next one may lie at most:
    `reach` m. `allowance`: turns that the tool may stand off by."""

    parts: ChainParts
    last: Reached
    reach: float
    allowance: Allowance

    def near(self, part: Part) -> float:
        """Place on a part from which the next rows go on."""
        if self.last.part == part:
            return self.last.at
        return self.parts.bounds(part.leg)[0] if part.leg <= self.parts.known else 0.0

    def on(self, part: Part, positions: Floats) -> On:
        """Where the next positions (R, 3) are on a part."""
        return self.parts.on(part, positions, self.near(part))

    def distance_taken(self, leg: int, rows: Pose, final: bool) -> float | None:
        """At what distance, m, the next rows pass the end of a leg, None where they do not tell."""
        first, second = self.parts.legs[leg : leg + 2]
        near = self.near(Part(leg, False))
        return distance_taken((first.curve, second.curve), first.corner, rows, near, final, self.allowance)

    def fitting(self, here: Part, row: Floats, within: float = PATH_POSITION) -> Part | None:
        """The first part behind `here` that a row (1, 3) lies within so many m of, or the one before it."""
        part = self.parts.next(here)
        while part is not None and self._is_in_reach(part):
            if self._lies_on(part, row, within):
                return part
            if self.parts.is_open(part.leg):
                # What is behind it is not known.
                return None
            part = self.parts.next(part)
        before = self.parts.before(here)
        if before is not None and self.on(before, row)[1][0] <= within:
            return before
        return None

    @property
    def has_unseen(self) -> bool:
        """Whether corners that are not known are in reach."""
        known = self.parts.known
        return known < len(self.parts.legs) - 1 and self._is_in_reach(Part(known, False))

    def behind_unseen(self, rows: Pose, within: float) -> tuple[Part, ChainParts] | None:
        """The first part within so many m of the first of rows, behind corners of which no row before it
        tells: legs may be run within a tick. With it the parts, those corners being passed as rows fit best,
        if any do, else as widely as may be."""
        trial, row = self.parts.copy(), rows[0][:1]
        tried = self._replace(parts=trial)
        for leg in range(trial.known, len(trial.legs) - 1):
            if not tried._is_in_reach(Part(leg, False)):
                break
            tried._settle(leg, rows)
            blend, following = Part(leg, True), Part(leg + 1, False)
            if trial.blend(blend) is not None and tried._lies_on(blend, row, within):
                return blend, trial
            if tried._lies_on(following, row, within):
                return following, trial
        return None

    def _is_in_reach(self, part: Part) -> bool:
        return self.parts.start(part) <= self.last.along + self.reach + PATH_POSITION

    def _settle(self, leg: int, rows: Pose) -> None:
        """Let the end of a leg be passed as rows fit best, if it is not known."""
        distance = self.distance_taken(leg, rows, True) if self.parts.is_open(leg) else None
        if distance is None:
            self.parts.settle_told(leg)
        else:
            self.parts.settle(distance)

    def _lies_on(self, part: Part, row: Floats, within: float) -> bool:
        if not part.blend and self.parts.is_open(part.leg):
            # Its blend is found out when it is reached.
            return self._off_curve(part.leg, row) <= within
        if not part.blend:
            self.parts.settle_told(part.leg)
        _, off, past = self.on(part, row)
        return bool(off[0] <= within and not past[0])

    def _off_curve(self, leg: int, row: Floats) -> float:
        """How far a row (1, 3) is off a leg, its blends left away."""
        curve = self.parts.legs[leg].curve
        way = np.clip(curve.nearest(row, self.near(Part(leg, False))), 0.0, curve.length)
        return float(np.linalg.norm(row[0] - curve.points(way)[0]))
