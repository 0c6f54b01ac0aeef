"""Knots of a path for planning, independent of the tick."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from irlx.motion.pose_path import PosePath, Poses
from irlx.motion.time_law import TimeLaw

Array = NDArray[np.float64]

STEP = 0.004
"""Programmed time of an interval at full speed, s."""

LONG_STEP = 0.016
"""The same for motions so long that fine knots would cost much and bring nothing, s."""

LONG_MOTION = 60.0
"""Programmed duration from which on `LONG_STEP` is reached, s; shorter ones lie between."""

LEAST_INTERVALS = 40

MOST_INTERVALS = 20_000
"""More knots would cost time and memory; a motion this long has them close enough."""

_ON_A_KNOT = 1e-9
"""A corner nearer to a knot than this part of an interval lies on it."""

_NEAREST_CORNERS = 1e-4
"""Corners closer than this part of an interval are one: a curve through knots so close bends by rounding."""


@dataclass(frozen=True)
class Spacing:
    """How far apart knots are: `factor` times the usual programmed times, and at least `least` intervals."""

    factor: float = 1.0
    least: int = LEAST_INTERVALS


FINE = Spacing()


@dataclass(frozen=True)
class PathGrid:
    """Knots `s` (N + 1,) of the path parameter with their tool poses.

    `times` (N,) programmed time of each interval, s; `rates` (N + 1,) programmed ds/dt at the knots;
    `step` programmed time of an interval at full speed, s.
    """

    s: Array
    times: Array
    rates: Array
    poses: Poses
    step: float

    @property
    def intervals(self) -> int:
        """Number N of intervals."""
        return int(self.times.size)

    def times_at(self, s: Array) -> Array:
        """Programmed times (M,) at path parameters (M,), s; between knots in proportion."""
        return np.asarray(np.interp(s, self.s, np.concatenate([[0.0], np.cumsum(self.times)])))

    def inner_knot(self, s: float) -> int:
        """The knot next to a path parameter, the first and the last one left out."""
        return int(np.clip(np.argmin(np.abs(self.s - s)), 1, self.intervals - 1))


def path_grid(path: PosePath, law: TimeLaw, spacing: Spacing = FINE) -> PathGrid:
    """Knots of a path that is programmed to be run by `law`.

    Pieces between the corners of the law are cut evenly, into intervals of about `STEP` at full
    speed, at least `LEAST_INTERVALS` in all, or as `spacing` says; a clock whose knots miss the corners
    loses 1E-3 of its time.
    """
    step = spacing.factor * float(np.clip(STEP * law.duration / LONG_MOTION * 4.0, STEP, LONG_STEP))
    width = min(max(law.speed * step, path.length / MOST_INTERVALS), path.length / spacing.least)
    corners = _apart(law, _NEAREST_CORNERS * width)
    pieces = [
        np.linspace(start, end, max(1, int(np.ceil((end - start) / width - 1e-9))) + 1)[1:]
        for start, end in pairwise(corners)
    ]
    s = np.concatenate([[0.0], *pieces])
    return PathGrid(s, np.diff(law.times_at(s)), law.rates_at(s), path.poses(s), step)


def acc_between(law: TimeLaw, s: Array) -> Array:
    """Largest |d2s/dt2| that a law allows anywhere between neighbours of the ways s (N + 1,): (N,).

    Moves joined to one path have each their own; the law has corners where one hands over to the next.
    """
    acc = law.acc_at(0.5 * (s[:-1] + s[1:]))
    corners = np.array(law.corners[1:-1])
    interval = np.clip(np.searchsorted(s, corners, side="right") - 1, 0, len(acc) - 1)
    beside = np.minimum(corners - s[interval], s[interval + 1] - corners)
    inside = beside > _ON_A_KNOT * (s[interval + 1] - s[interval])
    np.minimum.at(acc, interval[inside], law.acc_at(corners[inside]))
    return acc


def _apart(law: TimeLaw, least: float) -> list[float]:
    """The corners of a law without inner ones that lie within `least` of the one before or of the end.

    Of those that are one the slowest stays: in a narrow bend that is where the tool must be slow.
    """
    corners, rates = law.corners, law.rates_at(np.array(law.corners)).tolist()
    kept, lowest = [corners[0]], 0.0
    for corner, rate in zip(corners[1:-1], rates[1:-1], strict=True):
        if corners[-1] - corner <= least:
            break
        if corner - kept[-1] > least:
            kept.append(corner)
        elif rate < lowest:
            kept[-1] = corner
        else:
            continue
        lowest = rate
    return [*kept, corners[-1]]
