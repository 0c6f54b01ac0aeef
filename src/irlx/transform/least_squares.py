"""Least squares within bounds, for few rows: a projected Levenberg-Marquardt method."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

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
_FEW = 3
"""Searches up to which their steps are found one by one as fast as together."""


def least_squares_in_bounds(residual: Residual, start: Array, lower: Array, upper: Array) -> Array:
    """x (n,) with lower <= x <= upper where |r(x)|^2 is least, as far as it falls from `start`.

    Each step is d = -J' (J J' + c I)^-1 r without the columns of variables that stand on a bound and are
    pushed against it; variables that it would lead beyond a bound go as far as that, and the others make up
    for it. c falls while the linear model foretells well, and rises until a step makes the residual smaller:
    in the end it is a projected gradient step, which always does. Rows are few, so that systems are of m
    unknowns, not n (Nocedal and Wright, Numerical Optimization, 10.3, 16.7).
    """
    search = _Search(residual, start, lower, upper)
    while not search.over:
        search.take(_step(search))
    return search.x


def least_squares_from(
    residuals: Sequence[Residual], starts: Sequence[Array], lower: Array, upper: Array
) -> Iterator[tuple[int, Array]]:
    """What `least_squares_in_bounds` finds from each of some starts (n,), each with a residual of its own.

    Number of the start and x (n,), in the order in which the searches end. They take their steps side by
    side: a step of one takes longer by all that Python does about it than by its numbers.
    """
    going = [
        (k, _Search(residual, start, lower, upper))
        for k, (residual, start) in enumerate(zip(residuals, starts, strict=True))
    ]
    while going:
        yield from ((k, search.x) for k, search in going if search.over)
        going = [(k, search) for k, search in going if not search.over]
        searches = [search for _, search in going]
        steps = map(_step, searches) if len(going) <= _FEW else _steps(searches)
        for search, step in zip(searches, steps, strict=True):
            search.take(step)


class _Search:
    """A search under way: x (n,), its residual r, derivative J and damping c; whether it is `over`."""

    def __init__(self, residual: Residual, start: Array, lower: Array, upper: Array) -> None:
        self._residual, self.lower, self.upper = residual, lower, upper
        self.x = np.minimum(np.maximum(start, lower), upper)
        self.r, self.derivative = residual(self.x)
        self.damping = _DAMPING
        self._cost = float(self.r @ self.r)
        self._gainless, self._left = 0, _EVALUATIONS
        self.over = self._cost <= _MET

    def take(self, step: Array) -> None:
        """Take a step if it makes the residual smaller, else the next one will be shorter."""
        if float(np.max(np.abs(step))) < _NO_WAY:
            self.over = True
            return
        self._left -= 1
        there, turned = self._residual(self.x + step)
        new = float(there @ there)
        if new < self._cost:
            foretold = self._cost - float(np.sum((self.r + self.derivative @ step) ** 2))
            self._gainless = self._gainless + 1 if self._cost - new < _NO_GAIN * self._cost else 0
            if self._cost - new > _TRUSTED * foretold:
                self.damping = max(self.damping * _EASED, _LEAST_DAMPING)
            # Added bit by bit a value may pass its bound by a rounding.
            self.x = np.minimum(np.maximum(self.x + step, self.lower), self.upper)
            self.r, self.derivative, self._cost = there, turned, new
        else:
            self.damping *= _HARDENED
        ended = self._left == 0 or self._gainless == _GAINLESS
        self.over = ended or self._cost <= _MET or self.damping > _MOST_DAMPING


def _step(search: _Search) -> Array:
    """The damped step within the bounds."""
    r, derivative = search.r, search.derivative
    damping = search.damping * np.eye(len(r))
    lower, upper = search.lower - search.x, search.upper - search.x
    slope = r @ derivative
    moving = ~(((lower >= 0.0) & (slope > 0.0)) | ((upper <= 0.0) & (slope < 0.0)))
    way = _damped(r, np.where(moving, derivative, 0.0), damping)
    cut = np.minimum(np.maximum(way, lower), upper)
    beyond = cut != way
    if not np.any(beyond):
        return cut
    fixed = np.where(beyond, cut, 0.0)
    rest = _damped(r + derivative @ fixed, np.where(moving & ~beyond, derivative, 0.0), damping)
    return np.asarray(np.minimum(np.maximum(fixed + rest, lower), upper))


def _damped(r: Array, derivative: Array, damping: Array) -> Array:
    """-J' (J J' + C)^-1 r."""
    squares = derivative @ derivative.T + damping
    try:
        solved = np.linalg.solve(squares, r)
    except np.linalg.LinAlgError:
        # Far off all that can be reached derivatives are so large that a small damping is lost in rounding.
        solved = np.linalg.lstsq(squares, r, rcond=None)[0]
    return np.asarray(-(derivative.T @ solved))


def _steps(searches: Sequence[_Search]) -> Array:
    """What `_step` gives of each of several searches (K, n), but for roundings."""
    r, derivative = np.array([one.r for one in searches]), np.array([one.derivative for one in searches])
    damping = np.array([one.damping for one in searches])[:, None, None] * np.eye(r.shape[1])
    x = np.array([one.x for one in searches])
    lower, upper = searches[0].lower - x, searches[0].upper - x
    slope = (r[:, None] @ derivative)[:, 0]
    moving = ~(((lower >= 0.0) & (slope > 0.0)) | ((upper <= 0.0) & (slope < 0.0)))
    way = _damped_each(r, np.where(moving[:, None], derivative, 0.0), damping)
    cut = np.minimum(np.maximum(way, lower), upper)
    beyond = cut != way
    held = np.flatnonzero(np.any(beyond, axis=1))
    if held.size:
        fixed, others = np.where(beyond[held], cut[held], 0.0), (moving & ~beyond)[held, None]
        left = r[held] + (derivative[held] @ fixed[..., None])[..., 0]
        rest = _damped_each(left, np.where(others, derivative[held], 0.0), damping[held])
        cut[held] = np.minimum(np.maximum(fixed + rest, lower[held]), upper[held])
    return np.asarray(cut)


def _damped_each(r: Array, derivative: Array, damping: Array) -> Array:
    """`_damped` of each of several rows (K, m), matrices (K, m, n) and dampings (K, m, m)."""
    try:
        solved = np.linalg.solve(derivative @ derivative.transpose(0, 2, 1) + damping, r[..., None])[..., 0]
    except np.linalg.LinAlgError:
        return np.array([_damped(*one) for one in zip(r, derivative, damping, strict=True)])
    return np.asarray(-(solved[:, None] @ derivative)[:, 0])
