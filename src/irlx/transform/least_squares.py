"""Least squares within bounds, for few rows: a projected Levenberg-Marquardt method."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Residual = Callable[[Array], tuple[Array, Array]]
"""Gives the residual r(x) (m,) and its derivative (m, n)."""

_DAMPING = 1e-2
_LEAST_DAMPING, _MOST_DAMPING = 1e-12, 1e8
_EASED, _HARDENED = 0.2, 5.0
_TRUSTED = 0.5
"""Share of the decrease foretold by the linear model from which on damping is eased."""
_MET = 1e-24
_NO_WAY = 1e-14
_NO_GAIN = 1e-13
_GAINLESS = 3
_EVALUATIONS = 300


def least_squares_in_bounds(residual: Residual, start: Array, lower: Array, upper: Array) -> Array:
    """x (n,) with lower <= x <= upper where |r(x)|^2 is least, as far as it falls from `start`.

    Each step is d = -J' (J J' + c I)^-1 r without the columns of variables that stand on a bound and are
    pushed against it; variables that it would lead beyond a bound go as far as that, and the others make up
    for it. c falls while the linear model foretells well, and rises until a step makes the residual smaller:
    in the end it is a projected gradient step, which always does. Rows are few, so that systems are of m
    unknowns, not n (Nocedal and Wright, Numerical Optimization, 10.3, 16.7).
    """
    x = np.minimum(np.maximum(start, lower), upper)
    r, derivative = residual(x)
    cost, damping, gainless = float(r @ r), _DAMPING, 0
    eye = np.eye(len(r))
    for _ in range(_EVALUATIONS):
        if cost <= _MET or damping > _MOST_DAMPING:
            break
        step = _step(r, derivative, damping * eye, lower - x, upper - x)
        if float(np.max(np.abs(step))) < _NO_WAY:
            break
        there, turned = residual(x + step)
        new = float(there @ there)
        if not new < cost:
            damping *= _HARDENED
            continue
        foretold = cost - float(np.sum((r + derivative @ step) ** 2))
        gainless = gainless + 1 if cost - new < _NO_GAIN * cost else 0
        if cost - new > _TRUSTED * foretold:
            damping = max(damping * _EASED, _LEAST_DAMPING)
        # Added bit by bit a value may pass its bound by a rounding.
        x = np.minimum(np.maximum(x + step, lower), upper)
        r, derivative, cost = there, turned, new
        if gainless == _GAINLESS:
            break
    return x


def _step(r: Array, derivative: Array, damping: Array, lower: Array, upper: Array) -> Array:
    """The damped step within lower <= 0 <= upper."""
    slope = r @ derivative
    moving = ~(((lower >= 0.0) & (slope > 0.0)) | ((upper <= 0.0) & (slope < 0.0)))
    way = _damped(r, np.where(moving, derivative, 0.0), damping)
    cut = np.minimum(np.maximum(way, lower), upper)
    beyond = cut != way
    if not np.any(beyond):
        return cut
    fixed = np.where(beyond, cut, 0.0)
    rest = _damped(r + derivative @ fixed, np.where(moving & ~beyond, derivative, 0.0), damping)
    return np.minimum(np.maximum(fixed + rest, lower), upper)


def _damped(r: Array, derivative: Array, damping: Array) -> Array:
    """-J' (J J' + C)^-1 r."""
    return np.asarray(-(derivative.T @ np.linalg.solve(derivative @ derivative.T + damping, r)))
