"""When the Newton steps of a tick have settled: by what the last step leaves, not by its size.

What a tick leaves of the criterion's minimum comes back in second differences, up to 4 / dt^2 of it.
Near the end each step leaves a fixed share of the error before it, because the QP knows the
criterion's curvature and not the path's.
"""

from __future__ import annotations

from math import inf, sqrt

import numpy as np
from numpy.typing import NDArray

from irlx.transform.precision import (
    MOST_CALM_STEPS,
    ORIENTATION_TOLERANCE,
    POSITION_TOLERANCE,
    ROUNDING_STEP,
    SETTLED_ERROR,
    SETTLED_STEP,
)

SURELY_MET = min(POSITION_TOLERANCE, ORIENTATION_TOLERANCE) ** 2
"""Square of what is left of a demand that is surely met: both parts are shorter than the whole."""

_BEND = 5.0
_LARGEST_GUESS = 0.5


class Settling:
    """Watches the steps of one tick.

    The share of the error that a step leaves grows with the pull of the criterion against the path.
    Measured on arms in ordinary postures it is 0.1 to 3 times the pull (rad or m): `_BEND` stands above
    that. The sizes of two steps in a row measure it as well, but only along the first of them, and that
    one often lies along the path; so what they say counts where it is more.
    """

    __slots__ = ("_measured", "before", "calm")

    def __init__(self) -> None:
        self._measured = 0.0
        self.before = 0.0
        self.calm = 0

    def after(self, size: float, pull: float, met: bool) -> bool:
        """Whether a full step is the last one. To be asked once for each step, in order.

        `size` is its length (2-norm, rad and m), `pull` the length of H^-1 g, `met` whether the pose
        error it started from is within tolerance.
        """
        if self.before > 0.0:
            # The largest counts: behind a step of another share than 1 the next one is too small.
            self._measured = max(self._measured, size / self.before)
        self.before = size
        if not (met and size <= SETTLED_STEP):
            return False
        self.calm += 1
        share = max(min(_BEND * pull, _LARGEST_GUESS), self._measured)
        left = size * share / (1.0 - share) if share < 1.0 else inf
        # Steps of rounding do not shrink any more; a few of them are enough.
        return size <= ROUNDING_STEP or left <= SETTLED_ERROR or self.calm >= MOST_CALM_STEPS


def settles_at_once(size: float, pull: float) -> bool:
    """What `Settling.after` says of the first step of a tick that began with its pose met."""
    if size > SETTLED_STEP:
        return False
    share = min(_BEND * pull, _LARGEST_GUESS)
    return size <= ROUNDING_STEP or size * share / (1.0 - share) <= SETTLED_ERROR


def is_met(left: NDArray[np.float64], linear: int) -> bool:
    """Whether what is left of a demand, (m,), the first `linear` of it m, the rest rad, is within tolerance.

    Conditions between joints count like angles.
    """
    if left.dot(left) <= SURELY_MET:
        return True
    at, angles = left[:linear], left[linear:]
    return sqrt(at.dot(at)) <= POSITION_TOLERANCE and sqrt(angles.dot(angles)) <= ORIENTATION_TOLERANCE
