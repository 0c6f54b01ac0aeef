"""What comes nearest in every row of a motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from irlx.transform.clearance import Clearance, Closest

Array = NDArray[np.float64]

FAR = -1
"""Stands for a pair where all are farther away than they count."""

WITHIN = 1.0 - 1e-9
"""Part of its influence up to which a pair is near: some links always stand at that very distance, but for
rounding."""


@dataclass(frozen=True)
class NearestRows:
    """The pair of each row with the least room above its margin: index (N,) into `pairs`, or `FAR`.

    `pairs` are the names of a link and of an obstacle or another link, each with the `margin` (K,) kept
    between them; `distance` (N,) m, infinite where everything is far.
    """

    pair: NDArray[np.int64]
    distance: Array
    pairs: tuple[tuple[str, str], ...]
    margin: Array

    def part(self, first: int, last: int) -> NearestRows:
        """Rows from `first` on, before `last`."""
        return replace(self, pair=self.pair[first:last], distance=self.distance[first:last])


def nearest_rows(clearance: Clearance | None, q: Array, dt: float) -> NearestRows | None:
    """What comes nearest at postures q (N, n), the first one dt s after the begin of the motion.

    None where nothing is kept clear.
    """
    if clearance is None:
        return None
    found = [clearance.closest(posture, (row + 1) * dt) for row, posture in enumerate(q)]
    return nearest_of(clearance, found)


def nearest_of(clearance: Clearance, found: Sequence[Closest]) -> NearestRows:
    """What comes nearest in N rows, from what `Clearance.closest` tells of each."""
    names: dict[tuple[str, str], int] = {}
    margins: list[float] = []
    pair, distance = np.full(len(found), FAR, dtype=np.int64), np.full(len(found), np.inf)
    for row, nearest in enumerate(found):
        if nearest is None:
            continue
        watched = clearance.distances.pairs[nearest[0]]
        if nearest[1] >= WITHIN * watched.influence:
            continue
        key = (watched.link, watched.other)
        if key not in names:
            names[key] = len(names)
            margins.append(watched.margin)
        pair[row], distance[row] = names[key], nearest[1]
    return NearestRows(pair, distance, tuple(names), np.array(margins))
