"""Pairs that are near their margins at the knots of a curve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.slowdown.grid import PathGrid
from irlx.pacing.slowdown.model import Model

Array = NDArray[np.float64]

_BAND = 0.05


@dataclass(frozen=True)
class NearKnots:
    """M pairs at inner knots.

    Numbers of these `knots` (M,), rising; `room` (M,) above margin and reserve, m; `rates` (M, f), how that
    grows with each free joint.
    """

    knots: NDArray[np.intp]
    room: Array
    rates: Array

    def room_after(self, change: Array) -> Array:
        """Room (M,), to first order, after a change (N + 1, f) of the postures."""
        return np.asarray(self.room + np.einsum("mf,mf->m", self.rates, change[self.knots]))


def near_knots(model: Model, grid: PathGrid, q: Array, reserve: float) -> NearKnots | None:
    """Pairs within 50 mm of their margins at the inner ones of postures q (N + 1, n); None: there are none.

    What is inside its margin at the first posture may stay as near as it is there.
    """
    clearance = model.clearance
    if clearance is None:
        return None
    distances = clearance.distances
    least = clearance.floors(np.arange(len(distances.pairs)), q[0], reserve)
    knots, room, rates = [], [], []
    times = grid.times_at(grid.s)
    for knot in range(1, len(q) - 1):
        clearance.after(float(times[knot]))
        if distances.far(q[knot]):
            continue
        near = distances.near(q[knot], least + _BAND)
        if len(near.pairs):
            points = distances.jacobians(q[knot], near)
            rates.append(np.einsum("pi,pij->pj", near.away, points)[:, model.free])
            room.append(near.distance - least[near.pairs])
            knots.append(np.full(len(near.pairs), knot))
    if not knots:
        return None
    return NearKnots(np.concatenate(knots), np.concatenate(room), np.vstack(rates))
