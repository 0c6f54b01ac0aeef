"""Where Newton's method begins a tick: the last steps of a walk, continued."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_CONTINUATION = (-1.0, 4.0, -6.0, 4.0)
"""Weights of the last four steps, the oldest first."""

_CONTINUATION_AT = [np.roll(_CONTINUATION, k) for k in range(len(_CONTINUATION))]
"""The same for a ring of steps in which the oldest one stands at place k."""


class Seeds:
    """Continues the last steps of a walk as a cubic in time.

    S_k = 4 S_(k-1) - 6 S_(k-2) + 4 S_(k-3) - S_(k-4); a walk begins at rest.
    """

    def __init__(self, joints: int) -> None:
        self._last = np.zeros((len(_CONTINUATION), joints))
        self._place = 0

    def next(self) -> Array:
        """Step (n,) that continues the last ones."""
        return np.asarray(_CONTINUATION_AT[self._place].dot(self._last))

    def took(self, step: Array) -> None:
        """Note the step (n,) of a tick."""
        self._last[self._place] = step
        self._place = (self._place + 1) % len(_CONTINUATION)

    def copy(self) -> Seeds:
        """The same, to go on from here once more."""
        found = Seeds(0)
        found._last, found._place = self._last.copy(), self._place
        return found
