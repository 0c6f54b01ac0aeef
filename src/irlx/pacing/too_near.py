"""Says what comes too near to what, and refuses motions for it."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np
from numpy.typing import NDArray

from irlx.diagnostics import Diagnostic, Place, report
from irlx.pacing.errors import PacingError
from irlx.pacing.resolution import RowTicks
from irlx.scene.watched_pair import WatchedPair
from irlx.transform.clearance import Clearance, TooNear

Array = NDArray[np.float64]


def told_pair(pair: WatchedPair) -> str:
    """A pair in words."""
    other = "obstacle" if pair.obstacle is not None else "link"
    return f"link '{pair.link}' and {other} '{pair.other}'"


def apart(distance: float, digits: int = 4) -> str:
    """A distance in words, mm; below 0 solids overlap."""
    overlap = " (they overlap)" if distance < 0.0 else ""
    return f"{distance * 1e3:.{digits}g} mm{overlap}"


def told(clearance: Clearance, found: TooNear) -> dict[str, Any]:
    """What messages say of a pair, with as many digits as tell both distances apart.

    A pair that has come down to what it keeps can come no nearer: then the least is told.
    """
    pair = clearance.distances.pairs[found.pair]
    for digits in range(4, 10):
        distance, floor = apart(found.distance, digits), apart(found.floor, digits)
        if distance != floor:
            break
    else:
        floor = apart(found.floor)
        distance = f"less than {floor}"
    return {"pair": told_pair(pair), "distance": distance, "floor": floor}


def check_rows(
    clearance: Clearance | None,
    rows: Array,
    start: Array,
    ticking: RowTicks,
    word: str,
    place: Place,
) -> None:
    """Check rows (N, n) of a motion from posture `start` (n,) that avoids nothing by itself.

    Raises PacingError, IRL561, at the first row that comes too near to something.
    """
    elapsed = ticking.elapsed(len(rows))
    short = clearance.first_short(rows, start, elapsed) if clearance is not None else None
    if clearance is not None and short is not None:
        row, found = short
        raise PacingError(
            report("IRL561", place, word=word, tick=ticking.tick(row), **told(clearance, found))
        )


def passed_by(clearance: Clearance | None, rows: Array, ticking: RowTicks, place: Place) -> list[Diagnostic]:
    """A warning, IRL564, where an obstacle that moves comes too near in the last of rows (N, n), a hold."""
    if clearance is None or not clearance.distances.moves or len(rows) == 0:
        return []
    short = clearance.short(rows[-1], rows[-1], float(ticking.elapsed(len(rows))[-1]))
    if short is None:
        return []
    return [report("IRL564", place, tick=ticking.tick(len(rows) - 1), **told(clearance, short))]


def standing(
    clearance: Clearance | None, q: Array, others: Collection[str], place: Place
) -> list[Diagnostic]:
    """Warnings, IRL563, of pairs inside their margins where a robot stands: of links with these `others`.

    Raises PacingError, IRL562, where two overlap: how far they are in each other tells no way out.
    """
    found: list[Diagnostic] = []
    if clearance is None:
        return found
    distances = clearance.after(0.0)
    near = distances.near(q, distances.margin)
    for pair, distance in zip(near.pairs.tolist(), near.distance.tolist(), strict=True):
        if distances.pairs[pair].other not in others:
            continue
        words = told_pair(distances.pairs[pair])
        if distance < 0.0:
            raise PacingError(report("IRL562", place, pair=words, depth=apart(-distance)))
        margin = apart(float(distances.margin[pair]))
        found.append(report("IRL563", place, pair=words, distance=apart(distance), margin=margin))
    return found
