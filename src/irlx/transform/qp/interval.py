"""The QP with one unknown: an interval, cut by every row in turn. All a 7-axis arm needs."""

from __future__ import annotations

import numpy as np

from irlx.transform.precision import EMPTY_INTERVAL
from irlx.transform.qp.solver import Array, QpSolution

_NO_SLOPE = 1e-14


class IntervalSolver:
    """Closed form of the least-norm problem for r = 1."""

    def solve(self, rows: Array, lower: Array, upper: Array) -> QpSolution:
        """Solve min 1/2 z^2 with lower <= a z <= upper, rows a of shape (n, 1)."""
        slope = rows[:, 0]
        active = np.zeros(slope.shape[0], dtype=np.int8)
        flat = np.abs(slope) <= _NO_SLOPE * max(float(np.max(np.abs(slope))), 1e-300)
        if np.any(flat & ((lower > EMPTY_INTERVAL) | (upper < -EMPTY_INTERVAL))):
            return QpSolution(None, active)
        safe = np.where(flat, 1.0, slope)
        at_lower, at_upper = lower / safe, upper / safe
        least = np.where(flat, -np.inf, np.minimum(at_lower, at_upper))
        most = np.where(flat, np.inf, np.maximum(at_lower, at_upper))
        low, high = int(np.argmax(least)), int(np.argmin(most))
        scale = max(abs(least[low]), abs(most[high]), 1.0) if np.isfinite(least[low] + most[high]) else 1.0
        if least[low] - most[high] > EMPTY_INTERVAL * scale:
            return QpSolution(None, active)
        z = 0.0
        if least[low] > 0.0:
            z, row, at = float(least[low]), low, at_lower
        elif most[high] < 0.0:
            z, row, at = float(most[high]), high, at_lower
        else:
            return QpSolution(np.zeros(1), active)
        active[row] = -1 if at[row] == z else 1
        return QpSolution(np.array([z]), active)
