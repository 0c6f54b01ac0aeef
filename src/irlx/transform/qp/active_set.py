"""From a nearly right set of active rows to the exact least-norm solution."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.transform.qp.solver import Array, QpSolution

_ROUNDING = 1e-12


def sharpen(rows: Array, lower: Array, upper: Array, active: NDArray[np.int8]) -> QpSolution | None:
    """Exact solution of min 1/2 |z|^2, lower <= A z <= upper, started from a guess of active rows.

    Holds the active rows at their bounds, z = Aa' (Aa Aa')^-1 b, then adds the row that breaks most
    or drops the row that pulls the wrong way, until neither is left. A QP solver's accuracy in z
    would come back as acceleration noise, divided by the square of the tick; this does not.
    Returns None where no set is found within 4 n + 4 changes.
    """
    side = active.astype(np.float64)
    for _ in range(4 * rows.shape[0] + 4):
        held = np.flatnonzero(side)
        values = np.where(side[held] > 0, upper[held], lower[held])
        z, multipliers = _least_norm(rows[held], values)
        if z is None or multipliers is None:
            return None
        missed = np.abs(rows[held] @ z - values)
        if held.size and float(np.max(missed)) > _ROUNDING * max(1.0, float(np.max(np.abs(values)))):
            # Rows that depend on each other but for rounding have factors, and no common point.
            return None
        # A row held at its upper bound pushes down, one held at its lower bound pushes up.
        pull = multipliers * side[held]
        if held.size and float(np.max(pull)) > _ROUNDING * float(np.max(np.abs(multipliers))):
            side[held[int(np.argmax(pull))]] = 0.0
            continue
        reached = rows @ z
        excess = np.maximum(reached - upper, lower - reached)
        excess[held] = 0.0
        worst = int(np.argmax(excess))
        if excess[worst] <= _ROUNDING * max(1.0, float(np.max(np.abs(reached)))):
            return QpSolution(z, side.astype(np.int8))
        side[worst] = 1.0 if reached[worst] > upper[worst] else -1.0
    return None


def _least_norm(rows: Array, values: Array) -> tuple[Array | None, Array | None]:
    """Shortest z with rows z = values, and the multipliers of the rows; None where rows depend."""
    if rows.shape[0] == 0:
        return np.zeros(rows.shape[1]), np.zeros(0)
    gram = rows @ rows.T
    try:
        np.linalg.cholesky(gram)
        multipliers = np.linalg.solve(gram, values)
    except np.linalg.LinAlgError:
        return None, None
    return rows.T @ multipliers, multipliers
