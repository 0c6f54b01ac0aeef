"""How near a run came to what it kept clear of."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.nearest_rows import FAR, NearestRows

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SmallestClearance:
    """The row with the least room above a margin: a link, an obstacle or another link, both distances in m,
    tick."""

    link: str
    other: str
    distance: float
    margin: float
    tick: int


@dataclass(frozen=True, eq=False, repr=False)
class Clearances:
    """What came nearest in each of N samples: index `pair` (N,) into `pairs`, and its `distance` (N,) m.

    Pairs are names of a link and of an obstacle or another link, with the `margin` (K,) m kept between
    them. -1 and an infinite distance where nothing was kept clear or all was beyond its influence;
    `watched` (N,) tells where anything was kept clear.
    """

    pair: NDArray[np.int64]
    distance: Array
    pairs: tuple[tuple[str, str], ...]
    margin: Array
    watched: NDArray[np.bool_]

    def __repr__(self) -> str:
        near = self.smallest
        words = "nothing was near" if near is None else f"{near.link} and {near.other} {near.distance:.6g} m"
        return f"<Clearances of {len(self.pair)} samples: {words}>"

    @property
    def smallest(self) -> SmallestClearance | None:
        """The sample with the least room above its margin, None where nothing was near."""
        rows = np.flatnonzero(self.pair != FAR)
        if not rows.size:
            return None
        room = self.distance[rows] - self.margin[self.pair[rows]]
        row = int(rows[np.argmin(room)])
        pair = int(self.pair[row])
        return SmallestClearance(*self.pairs[pair], float(self.distance[row]), float(self.margin[pair]), row)


def clearances(parts: Iterable[tuple[int, NearestRows | None]]) -> Clearances:
    """What came nearest over the parts of a run, each so many rows with or without something kept clear."""
    numbers: dict[tuple[str, str, float], int] = {}
    pair: list[NDArray[np.int64]] = [np.zeros(0, dtype=np.int64)]
    distance: list[Array] = [np.zeros(0)]
    watched: list[NDArray[np.bool_]] = [np.zeros(0, dtype=np.bool_)]
    for count, rows in parts:
        watched.append(np.full(count, rows is not None))
        if rows is None:
            pair.append(np.full(count, FAR, dtype=np.int64))
            distance.append(np.full(count, np.inf))
            continue
        own = zip(rows.pairs, rows.margin.tolist(), strict=True)
        known = [numbers.setdefault((*names, margin), len(numbers)) for names, margin in own]
        # The last entry is what FAR points to.
        pair.append(np.array([*known, FAR], dtype=np.int64)[rows.pair])
        distance.append(rows.distance)
    pairs = tuple((link, other) for link, other, _ in numbers)
    margin = np.array([margin for *_, margin in numbers])
    columns = np.concatenate(pair), np.concatenate(distance)
    return Clearances(*columns, pairs, margin, np.concatenate(watched))
