"""A library of inverse kinematics that follows poses tick by tick, each tick until it has converged."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from beside.line_and_circle import START
from beside.serving import Answer, Stopwatch

Array = NDArray[np.float64]

MET = 1e-6
"""Distance, m, and angle, rad, from the demanded pose with which a tick is done."""

MOST_SOLVES = 20


class NotConvergedError(Exception):
    """A tick did not come to its pose."""


class Follower(Protocol):
    """One library with its settings, at the start posture when it is made."""

    def aim(self, position: Array) -> None:
        """Take the position of the next tick, (3,) m; the orientation stays that of the start."""

    def solve(self) -> bool:
        """Solve once and take the step; whether the pose is met now, as the library itself sees it."""

    @property
    def q(self) -> Array:
        """Posture (7,), rad."""


Make = Callable[[str, float], Follower]
"""Makes a follower of the name of a case and a tick, s."""


def answers(make: Make) -> Callable[..., Answer]:
    """What answers the requests for a library: one round each, timed from the first tick to the last."""

    def answer(case: str, dt: float, targets: str, into: str) -> Answer:
        positions = np.load(targets)
        follower = make(case, dt)
        found, solves = np.empty((len(positions), START.size)), 0
        watch = Stopwatch()
        with watch:
            for tick, position in enumerate(positions):
                solves += _done(follower, position, tick)
                found[tick] = follower.q
        np.save(Path(into), found)
        return {"cpu": watch.cpu, "wall": watch.wall, "ticks": len(found), "solves": solves}

    return answer


def _done(follower: Follower, position: Array, tick: int) -> int:
    """Do a tick; how many solves it took."""
    follower.aim(position)
    for count in range(1, MOST_SOLVES + 1):
        if follower.solve():
            return count
    raise NotConvergedError(f"tick {tick} is not done after {MOST_SOLVES} solves")


def met(error: Array) -> bool:
    """Whether a twist (6,), m and rad, is within `MET`; by single numbers, which is what costs least."""
    x, y, z, a, b, c = error.tolist()
    return bool(x * x + y * y + z * z <= MET * MET and a * a + b * b + c * c <= MET * MET)
