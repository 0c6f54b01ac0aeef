"""What comes nearest in every row of a motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.transform.clearance import Clearance

Array = NDArray[np.float64]

FAR = -1
"""Stands for a pair where all are farther away than they count."""


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


def nearest_rows(clearance: Clearance | None, q: Array, dt: float) -> NearestRows | None:
    """What comes nearest at postures q (N, n), the first one dt s after the begin of the motion.

    None where nothing is kept clear.
    """
    if clearance is None:
        return None
    distances = clearance.distances
    names: dict[tuple[str, str], int] = {}
    margins: list[float] = []
    pair, distance = np.full(len(q), FAR, dtype=np.int64), np.full(len(q), np.inf)
    for row, posture in enumerate(q):
        clearance.after((row + 1) * dt)
        if distances.far(posture):
            continue
        near = distances.near(posture)
        if not len(near.pairs):
            continue
        k = int(np.argmin(near.distance - distances.margin[near.pairs]))
        watched = distances.pairs[int(near.pairs[k])]
        key = (watched.link, watched.other)
        if key not in names:
            names[key] = len(names)
            margins.append(watched.margin)
        pair[row], distance[row] = names[key], near.distance[k]
    return NearestRows(pair, distance, tuple(names), np.array(margins))
