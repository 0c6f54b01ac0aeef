"""How a criterion measures steps: its Hessian H, a diagonal (n,) or a full symmetric matrix (n, n)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def times(hessian: Array, d: Array) -> Array:
    """H d, shape (n,)."""
    return hessian * d if hessian.ndim == 1 else np.asarray(hessian @ d)


def solved(hessian: Array, g: Array) -> Array:
    """H^-1 g, shape (n,)."""
    return g / hessian if hessian.ndim == 1 else np.asarray(np.linalg.solve(hessian, g))


def rows_over(rows: Array, hessian: Array) -> Array:
    """R H^-1 of rows R (m, n), shape (m, n)."""
    return rows / hessian if hessian.ndim == 1 else np.asarray(np.linalg.solve(hessian, rows.T).T)


def reduced(hessian: Array, free: NDArray[np.bool_]) -> Array:
    """H of the joints that are free (n,): those that are not take no part."""
    return hessian[free] if hessian.ndim == 1 else hessian[np.ix_(free, free)]


def within_basis(hessian: Array, basis: Array) -> Array:
    """N' H N of a basis N (n, k), shape (k, k)."""
    return np.asarray((basis.T * hessian if hessian.ndim == 1 else basis.T @ hessian) @ basis)
