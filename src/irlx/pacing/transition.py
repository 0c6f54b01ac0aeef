"""Rows that lead the joints from one motion into another one: posture and speed of both at their ends."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]

RESERVE = 1e-9
"""Part of the limits left unused, so that rounding of the rows stays inside."""

_WIDTHS = (0.5, 0.15)
_CENTRES = np.linspace(0.1, 0.9, 9)


def transition(
    before: Array, behind: Array, ticks: int, limits: JointLimits, dt: float, alike: bool
) -> Array | None:
    """Rows (ticks - 1, n) from the last of the rows `before` (3, n) to the first of those `behind` (3, n).

    Second differences e_1 .. e_(ticks + 1) are a sum of two shapes, whose sizes follow for each joint from
    the two conditions that posture and speed are those of `behind`. Of several shapes - from that which takes
    over the accelerations of both sides (a quintic) over the straight line (a cubic) to a step between two
    levels - the smoothest is taken that keeps the speed and acceleration limits at ticks of `dt` s: for each
    joint, or with `alike` the same for all, which keeps linear relations between them. None where no shape
    does.
    """
    speed, ahead = before[2] - before[1], behind[1] - behind[0]
    sides = np.array([before[2] - 2 * before[1] + before[0], behind[2] - 2 * behind[1] + behind[0]])
    shapes, weights = _shapes(ticks + 1)
    wanted = np.array([ahead - speed, behind[0] - before[2] - ticks * speed])
    # The quintic alone takes over what the sides have.
    y = (np.arange(ticks + 1.0) + 0.5) / (ticks + 1.0)
    base = (1.0 - y)[:, None] * sides[0] + y[:, None] * sides[1]
    told = np.broadcast_to(wanted, (len(shapes), *wanted.shape)).copy()
    told[0] -= weights @ base
    sizes = np.linalg.solve(weights @ np.swapaxes(shapes, 1, 2), told)
    bends = np.swapaxes(shapes, 1, 2) @ sizes
    bends[0] += base
    speeds = speed + np.cumsum(bends, axis=1)
    kept = _inside(bends / dt**2, limits, "acceleration") & _inside(speeds / dt, limits, "speed")
    if alike:
        kept = np.broadcast_to(kept.all(axis=1, keepdims=True), kept.shape)
    if not kept.any(axis=0).all():
        return None
    chosen = np.argmax(kept, axis=0)
    steps = speeds[chosen, :-2, np.arange(len(chosen))].T
    rows = before[2] + np.cumsum(steps, axis=0)
    still = np.all(before == behind[0], axis=0) & np.all(behind == behind[0], axis=0)
    rows[:, still] = behind[0][still]
    return np.asarray(rows)


def _inside(values: Array, limits: JointLimits, kind: str) -> NDArray[np.bool_]:
    lower, upper = (bound * (1.0 - RESERVE) for bound in limits.pair(kind))
    return np.asarray(((values <= upper) & (values >= lower)).all(axis=1))


@lru_cache(maxsize=64)
def _shapes(count: int) -> tuple[Array, Array]:
    """Pairs of shapes (K, 2, count), the smoothest first; what each tick adds to speed and way (2, count)."""
    y = (np.arange(count) + 0.5) / count
    found = [(y * (1.0 - y) ** 2, y * y * (1.0 - y)), (1.0 - y, y)]
    for width in _WIDTHS:
        for centre in _CENTRES:
            rise = np.clip((y - centre) / width + 0.5, 0.0, 1.0)
            found.append((1.0 - rise, rise))
    return np.array(found), np.array([np.ones(count), count - 1.0 - np.arange(count)])
