"""A term that knows some of the joints only."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.transform.criteria.term import Term

Array = NDArray[np.float64]


class OfSomeJoints(Term):
    """`term` of the joints at places `joints` (n,) of more; the others have no part in it."""

    def __init__(self, term: Term, joints: NDArray[np.int64]) -> None:
        self.name = term.name
        self._term = term
        self._joints = joints

    def linear(self, q: Array, elapsed: float) -> Array:
        """b with zeros for the other joints."""
        found = np.zeros(q.size)
        found[self._joints] = self._term.linear(q[self._joints], elapsed)
        return found

    def quadratic(self, q: Array) -> Array | None:
        """B with zeros for the other joints."""
        own = self._term.quadratic(q[self._joints])
        if own is None:
            return None
        if own.ndim == 1:
            found = np.zeros(q.size)
            found[self._joints] = own
            return found
        whole = np.zeros((q.size, q.size))
        whole[np.ix_(self._joints, self._joints)] = own
        return whole

    def acts(self, q: Array) -> bool:
        """As the term does at its own joints."""
        return self._term.acts(q[self._joints])

    def posture_share(self, q: Array) -> float:
        """As that of the term at its own joints."""
        return self._term.posture_share(q[self._joints])
