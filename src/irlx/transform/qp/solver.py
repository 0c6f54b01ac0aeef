"""Interface of the QP solvers, and the answer they give."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class QpSolution:
    """Solution z, shape (r,), or None where the rows contradict each other.

    `active` (n,) is +1 for rows held at their upper bound, -1 for rows held at their lower one.
    """

    z: Array | None
    active: NDArray[np.int8]


class QpSolver(Protocol):
    """Solves  min 1/2 |z|^2  subject to  lower <= A z <= upper."""

    def solve(self, rows: Array, lower: Array, upper: Array) -> QpSolution:
        """Solve for rows A of shape (n, r), r >= 1, and bounds (n,), infinite where there are none."""
        ...
