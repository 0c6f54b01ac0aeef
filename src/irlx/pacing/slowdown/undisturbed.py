"""Postures of the knots in a dry run, where nothing stands in their way."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.slowdown.all_at_once import references, settle
from irlx.pacing.slowdown.grid import PathGrid
from irlx.pacing.slowdown.model import Model
from irlx.pacing.slowdown.room import Room
from irlx.transform.criteria.criterion import Criterion

Array = NDArray[np.float64]


def undisturbed_postures(
    model: Model,
    grid: PathGrid,
    guess: Array,
    criterion_of: Callable[[float, float], Criterion],
    bounds: tuple[Array, Array],
    reserve: float,
) -> Array | None:
    """Postures (N + 1, n) of the knots that the elastic walk would find without a stretch, all at once.

    From a `guess` (N + 1, n) whose first row is the start. None where a bound or something near has a part in
    them, or they are not found; `bounds` and `reserve` as for the walk.
    """
    drawn = references(
        criterion_of(float(s), float(way)) for s, way in zip(grid.s[1:], np.diff(grid.s), strict=True)
    )
    q = guess.copy()
    if drawn is None or not settle(model, q, model.targets(grid.poses), drawn):
        return None
    low, high = bounds
    room = Room.at(model, q[:-1], (low[1:], high[1:]), reserve, grid.times[:, None])
    if not room.holds(np.diff(q, axis=0)):
        return None
    clearance = model.clearance
    if clearance is not None and not clearance.untouched(q):
        return None
    return np.asarray(q)
