"""What came near while rows were followed tick by tick, and where a margin gave way."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from irlx.diagnostics import Diagnostic, Place, report
from irlx.pacing.too_near import apart, told_pair
from irlx.scene.watched_pair import WatchedPair
from irlx.transform.clearance import ALLOWANCE, Clearance

Array = NDArray[np.float64]


@dataclass(frozen=True)
class NearPair:
    """A link and an obstacle or another link at a tick, `distance` and `margin` in m; `line` of the move.

    The distance is negative where they overlap.
    """

    link: str
    other: str
    distance: float
    margin: float
    tick: int
    line: int


@dataclass(frozen=True)
class ObstacleReport:
    """Obstacles of a stream until now.

    `ticks` at which it was asked where they are, `placements` of obstacles that were answered; `near_ticks`
    at whose end something was inside its margin, `nearest` the pairs that were, each where it was deepest.
    """

    ticks: int = 0
    placements: int = 0
    near_ticks: int = 0
    nearest: tuple[NearPair, ...] = ()


class Nearness:
    """The report of a stream as it grows."""

    def __init__(self) -> None:
        self.report = ObstacleReport()
        self._deepest: dict[tuple[str, str], tuple[NearPair, WatchedPair, Place]] = {}

    def asked(self, placements: int) -> None:
        """Note that it was asked where obstacles are, and how many answers there were."""
        found = self.report
        self.report = replace(found, ticks=found.ticks + 1, placements=found.placements + placements)

    def ended(self, clearance: Clearance | None, q: Array, tick: int, place: Place) -> NearPair | None:
        """Note the posture q (n,) at the end of a tick; gives the pair with the least room above its margin.

        `clearance` begins at the end of the tick.
        """
        if clearance is None or clearance.after(0.0).far(q):
            return None
        distances = clearance.distances
        near = distances.near(q, np.maximum(distances.influence, distances.margin))
        if not len(near.pairs):
            return None
        room = near.distance - distances.margin[near.pairs]
        found = [
            NearPair(pair.link, pair.other, distance, pair.margin, tick, place.line or 0)
            for pair, distance in zip(
                (distances.pairs[k] for k in near.pairs.tolist()), near.distance.tolist(), strict=True
            )
        ]
        for k in np.flatnonzero(room < -ALLOWANCE).tolist():
            self._inside(found[k], distances.pairs[int(near.pairs[k])], place)
        if np.any(room < -ALLOWANCE):
            nearest = tuple(pair for pair, _, _ in self._deepest.values())
            self.report = replace(self.report, near_ticks=self.report.near_ticks + 1, nearest=nearest)
        return found[int(np.argmin(room))]

    def _inside(self, found: NearPair, pair: WatchedPair, place: Place) -> None:
        key = found.link, found.other
        known = self._deepest.get(key)
        if known is None or found.distance < known[0].distance:
            self._deepest[key] = found, pair, place

    @property
    def warnings(self) -> list[Diagnostic]:
        """A warning, IRL587, of each pair that was inside its margin, at the tick where it was deepest."""
        return [
            report(
                "IRL587",
                place,
                pair=told_pair(pair),
                distance=apart(found.distance),
                margin=apart(found.margin),
                tick=found.tick,
            )
            for found, pair, place in self._deepest.values()
        ]
