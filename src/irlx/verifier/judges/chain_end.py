"""Where the rows of a chain of moves are on its last leg, before the corner to the PTP behind it."""

from __future__ import annotations

import numpy as np

from irlx.promises import PATH_POSITION
from irlx.streams.joint_stream import Floats
from irlx.verifier.geometry.curves import Curve


def ways_on_last_circle(circle: Curve, positions: Floats, near: float | None, reach: float) -> Floats:
    """Ways (R,) m of all rows (R, 3) of the last move along its circle, up to the last one that lies on it;
    those behind that are at its end.

    `near` is the way of the row before, None where rows come from a blend: how much of the circle that takes
    is not known. Angles of rows in the corner do not tell how far they have come, but the last rows on the
    circle do: from there the corner, of `reach` m, leads to the end.
    """
    way = circle.nearest(positions, near or 0.0)
    on = np.linalg.norm(positions - circle.points(way), axis=1) <= PATH_POSITION
    # A single row may lie on it by chance: the corner may cross the circle.
    runs = on & (np.append(on[1:], False) | np.insert(on[:-1], 0, False))
    found = np.flatnonzero(runs if runs.any() else on)
    if not found.size:
        return np.full(len(way), circle.length)
    last = int(found[-1])
    if near is None:
        step = abs(way[last] - way[last - 1]) if last else 0.0
        missing = circle.length - reach - step - way[last]
        way = way + circle.whole * np.ceil(missing / circle.whole)
    way[last + 1 :] = circle.length
    return np.asarray(way)
