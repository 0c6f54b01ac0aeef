"""How a criterion measures steps: its Hessian H, a diagonal (n,) or a full symmetric matrix (n, n)."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular
from scipy.linalg.lapack import dposv

Array = NDArray[np.float64]


def times(hessian: Array, d: Array) -> Array:
    """H d, shape (n,)."""
    return hessian * d if hessian.ndim == 1 else np.asarray(hessian @ d)


def solved(hessian: Array, g: Array) -> Array:
    """H^-1 g, shape (n,)."""
    return g / hessian if hessian.ndim == 1 else np.asarray(np.linalg.solve(hessian, g))


def inverse(hessian: Array) -> Array:
    """H^-1, a diagonal (n,) or whole (n, n)."""
    if hessian.ndim == 1:
        return 1.0 / hessian
    _, found, failed = dposv(hessian, _identity(len(hessian)))
    return np.asarray(np.linalg.inv(hessian) if failed else found)


@cache
def _identity(size: int) -> Array:
    return np.eye(size)


def rows_over(rows: Array, hessian: Array) -> Array:
    """R H^-1 of rows R (m, n), shape (m, n)."""
    return rows / hessian if hessian.ndim == 1 else np.asarray(np.linalg.solve(hessian, rows.T).T)


def reduced(hessian: Array, free: NDArray[np.bool_]) -> Array:
    """H of the joints that are free (n,): those that are not take no part."""
    return hessian[free] if hessian.ndim == 1 else hessian[np.ix_(free, free)]


def root(hessian: Array) -> Array:
    """L of H = L L': square roots (n,) of a diagonal, the lower Cholesky factor (n, n) of a matrix."""
    return np.asarray(np.sqrt(hessian) if hessian.ndim == 1 else np.linalg.cholesky(hessian))


def rows_over_root(rows: Array, half: Array) -> Array:
    """R L^-T of rows R (m, n), L from `root`, shape (m, n)."""
    return rows / half if half.ndim == 1 else np.asarray(solve_triangular(half, rows.T, lower=True).T)


def solved_by_root(half: Array, x: Array, transposed: bool = True) -> Array:
    """L^-T x, or L^-1 x if not `transposed`, for x (n,) or (n, k), L from `root`."""
    if half.ndim == 1:
        return np.asarray((x.T / half).T)
    return np.asarray(solve_triangular(half, x, lower=True, trans=1 if transposed else 0))


def as_matrix(hessian: Array) -> Array:
    """H (n, n) whatever its form."""
    return np.diag(hessian) if hessian.ndim == 1 else hessian
