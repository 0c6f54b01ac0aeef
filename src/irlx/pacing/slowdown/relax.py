"""Smooths the postures of the knots in the null space of the path.

The elastic walk leaves kinks in q'(s) where bounds become active; a clock stops nearly dead at each.
Over d_i = Z_i y_i, Z_i a basis of the null space at knot i, with both ends held (what follows in the program
does not depend on the slowing), minimise

    sum_i a_i W |h^2 q''_i|^2 + a_i (h / l)^4 W |q_i - q_walk,i|^2
        + mu W (|dq_i| - 0.995 v dT_i)_+^2 + 1e5 W (position excess)_+^2,     l = tau x programmed speed,

h the widest spacing and a_i h that at knot i, so that the first two terms are integrals over s however the
knots lie (narrow ones would take bends of any size for nothing, and a clock all but stops there), and the
squares of what pairs lack of their margins, at the price of the joint step that would make up for it,

by Newton's method on the active set of the hinges (a band matrix), then back onto the path. A step that does
not lower the sum is halved: full ones may go to and fro between several sets for ever. A knot at which a
posture is asked for is pinned: there the price of the second term is 1e5.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from irlx.pacing.slowdown.grid import STEP, PathGrid
from irlx.pacing.slowdown.model import Model, null_spaces
from irlx.pacing.slowdown.near_knots import NearKnots, near_knots

Array = NDArray[np.float64]
Sides = NDArray[np.int8]

_SPEED_SHARE = 0.995
_POSITION_PRICE = 1e5
_PIN_PRICE = 1e5
_OUTER_ROUNDS = 4
_ACTIVE_ROUNDS = 40
_LONGEST_STEP = 0.2
_GOLDEN = 0.5 * (5.0**0.5 - 1.0)
_SECTIONS = 12
_SURE = 1e-9
"""Relative difference of two sums above which a rounding of their places does not change which is less."""
_ONTO_PATH_ROUNDS = 2
_SETTLED = 1e-4


@dataclass(frozen=True)
class Smoothing:
    """Strength of the relaxation: wave length `tau` (s) that is smoothed away, price `mu` of speed excess."""

    tau: float
    mu: float


def relax(
    model: Model,
    grid: PathGrid,
    walked: Array,
    bounds: tuple[Array, Array],
    smoothing: Smoothing,
    pinned: Sequence[int] = (),
    reserve: float = 0.0,
) -> Array:
    """Smoother postures (N + 1, n) on the same poses, from those of the walk; first and last stay, and those
    of the knots `pinned`.

    `bounds` are lower and upper positions (N + 1, n); `reserve` (m) is kept beside margins. Raises
    numpy.linalg.LinAlgError at singular knots.
    """
    if model.freedom < 1 or grid.intervals < 3:
        return walked
    targets = model.targets(grid.poses)
    q, jacobians = walked, model.differences(walked, targets)[1]
    for _ in range(_OUTER_ROUNDS):
        near = near_knots(model, grid, q, reserve) if model.clearance is not None else None
        basis = null_spaces(jacobians)
        relaxation = _Relaxation(model, grid, q, basis, walked, bounds, smoothing, pinned, near)
        step = relaxation.step()
        moved = q.copy()
        moved[1:-1, model.free] += step
        moved[1:-1] = np.clip(moved[1:-1], *(side[1:-1] for side in bounds))
        moved[1:-1, ~model.free] = walked[1:-1, ~model.free]
        moved, _, jacobians = model.onto_path(moved, targets, _ONTO_PATH_ROUNDS)
        moved[0], moved[-1] = walked[0], walked[-1]
        change = float(np.max(np.abs(moved - q)))
        q = moved
        if change < _SETTLED:
            break
    return q


class _Relaxation:
    """One linearisation at postures q: all quantities of free joints; interior knots 1 .. N - 1."""

    def __init__(
        self,
        model: Model,
        grid: PathGrid,
        q: Array,
        basis: Array,
        walked: Array,
        bounds: tuple[Array, Array],
        smoothing: Smoothing,
        pinned: Sequence[int],
        near: NearKnots | None,
    ) -> None:
        free = model.free
        self._weights = model.weights[free]
        self._q, self._walked = q[:, free], walked[:, free]
        self._lower, self._upper = bounds[0][:, free], bounds[1][:, free]
        basis[0] = basis[-1] = 0.0
        self._basis = basis
        limits = model.limits
        self._fastest = _SPEED_SHARE * limits.speed_upper[free] * grid.times[:, None]
        self._slowest = _SPEED_SHARE * limits.speed_lower[free] * grid.times[:, None]
        self._mu = smoothing.mu * (grid.step / STEP) ** 2
        shares = np.diff(grid.s) / np.max(np.diff(grid.s))
        self._second = _second_differences(shares)
        at_knots = 0.5 * (np.append(shares[0], shares) + np.append(shares, shares[-1]))
        self._attraction = (grid.step / smoothing.tau) ** 4 * at_knots
        self._attraction[list(pinned)] = _PIN_PRICE
        self._near = near
        if near is not None:
            length = np.maximum(np.einsum("mf,mf->m", near.rates, near.rates), 1e-12)
            self._near_price = _POSITION_PRICE * float(np.mean(self._weights)) / length

    def step(self) -> Array:
        """Change (N - 1, f) of the free joints at the interior knots, on the null spaces."""
        matrix, slope = self._smooth_part()
        change = np.zeros_like(self._q)
        best, least = change, self._sum(change)
        active = self._hinges(change)
        for _ in range(_ACTIVE_ROUNDS):
            blocks, gradient = self._with_hinges(matrix, slope, active)
            y = _solve_blocks(*blocks, -gradient)
            change = np.zeros_like(self._q)
            change[1:-1] = np.einsum("ifr,ir->if", self._basis[1:-1], y)
            found = self._hinges(change)
            if all(np.array_equal(a, b) for a, b in zip(found, active, strict=True)):
                best = change
                break
            total = self._sum(change)
            if total > least:
                change = self._lowest_between(best, change)
                found, total = self._hinges(change), self._sum(change)
            best, least = min((best, least), (change, total), key=lambda found: found[1])
            active = found
        change = best
        largest = float(np.max(np.abs(change), initial=0.0))
        return change[1:-1] * min(1.0, _LONGEST_STEP / max(largest, 1e-300))

    def _lowest_between(self, good: Array, change: Array) -> Array:
        """The change with the least sum on the way from a good one to another that is worse.

        The sum is convex: on the way to the worse one it falls first, and golden sections find where it ends.
        """
        way = change - good
        low, high = 0.0, 1.0
        kept_inner: float | None = None
        kept_outer: float | None = None
        for _ in range(_SECTIONS):
            inner, outer = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
            at_inner = self._sum(good + inner * way) if kept_inner is None else kept_inner
            at_outer = self._sum(good + outer * way) if kept_outer is None else kept_outer
            if abs(at_inner - at_outer) <= _SURE * max(at_inner, at_outer):
                at_inner, at_outer = self._sum(good + inner * way), self._sum(good + outer * way)
            # One of the points comes again in the next section, but for a rounding.
            if at_inner < at_outer:
                high, kept_inner, kept_outer = outer, None, at_inner
            else:
                low, kept_inner, kept_outer = inner, at_outer, None
        return good + 0.5 * (low + high) * way

    def _sum(self, change: Array) -> float:
        """What is minimised, at a change (N + 1, f) of the postures."""
        # Much of the time of a relaxation is spent here, on new arrays: old ones are used again.
        q, w = self._q + change, self._weights
        before, here, after = (factor[:, None] for factor in self._second)
        bent = before * q[:-2]
        bent += here * q[1:-1]
        bent += after * q[2:]
        bent *= bent
        away = q - self._walked
        away *= away
        away *= self._attraction[:, None]
        squares = bent.sum(axis=0) + away.sum(axis=0)
        out = _POSITION_PRICE * _beyond(q, self._lower, self._upper)
        if self._mu > 0.0:
            out += self._mu * _beyond(q[1:] - q[:-1], self._slowest, self._fastest)
        squares += out
        lacking = 0.0
        if self._near is not None:
            lacking = float(self._near_price @ np.maximum(-self._near.room_after(change), 0.0) ** 2)
        return float(w @ squares) + lacking

    def _smooth_part(self) -> tuple[tuple[Array, Array, Array], Array]:
        """Blocks (diagonal, first and second above) and gradient of the curvature and the attraction."""
        z, w = self._basis, self._weights
        before, here, after = self._second
        knots = len(z)
        main, next_one, next_two = np.zeros(knots), np.zeros(knots - 1), np.zeros(knots - 2)
        np.add.at(main, np.arange(0, knots - 2), before**2)
        np.add.at(main, np.arange(1, knots - 1), here**2)
        np.add.at(main, np.arange(2, knots), after**2)
        next_one[:-1] += before * here
        next_one[1:] += here * after
        next_two += before * after
        main = main + self._attraction
        one, first, second = (
            _reduced(z[: knots - k], factor[:, None] * w, z[k:])[1 : knots - 1 - k]
            for k, factor in enumerate((main, next_one, next_two))
        )
        bent = before[:, None] * self._q[:-2] + here[:, None] * self._q[1:-1] + after[:, None] * self._q[2:]
        pull = self._attraction[:, None] * (self._q - self._walked)
        pull[:-2] += before[:, None] * bent
        pull[1:-1] += here[:, None] * bent
        pull[2:] += after[:, None] * bent
        return (one, first, second), np.einsum("ifr,f,if->ir", z, w, pull)[1:-1]

    def _hinges(self, change: Array) -> tuple[Sides, Sides, Sides]:
        """Sides on which steps pass their speed (N, f) and positions their bounds (N + 1, f): 1, 0, -1.

        And the near pairs (M,) that lack distance.
        """
        q = self._q + change
        steps = np.diff(q, axis=0)
        fast = (steps > self._fastest).astype(np.int8) - (steps < self._slowest).astype(np.int8)
        out = (q > self._upper).astype(np.int8) - (q < self._lower).astype(np.int8)
        lacking = np.zeros(0, dtype=np.int8)
        if self._near is not None:
            lacking = (self._near.room_after(change) < 0.0).astype(np.int8)
        return fast, out, lacking

    def _with_hinges(
        self, blocks: tuple[Array, Array, Array], gradient: Array, active: tuple[Sides, Sides, Sides]
    ) -> tuple[tuple[Array, Array, Array], Array]:
        """The problem with the hinges in `active` as squares; `change` 0 is the point of linearisation."""
        z, w = self._basis, self._weights
        fast, out, lacking = active
        main, beside, second = blocks
        slope = np.zeros_like(self._q)
        price_out = _POSITION_PRICE * w * (out != 0)
        excess = np.where(out > 0, self._q - self._upper, np.where(out < 0, self._q - self._lower, 0.0))
        slope += price_out * excess
        diagonal = price_out
        if self._mu > 0.0:
            price = self._mu * w * (fast != 0)
            steps = np.diff(self._q, axis=0)
            over = np.where(fast > 0, steps - self._fastest, np.where(fast < 0, steps - self._slowest, 0.0))
            slope[:-1] -= price * over
            slope[1:] += price * over
            diagonal = diagonal.copy()
            diagonal[:-1] += price
            diagonal[1:] += price
            beside = beside - _reduced(z[1:-2], price[1:-1], z[2:-1])
        main = main + _reduced(z[1:-1], diagonal[1:-1], z[1:-1])
        near = self._near
        if near is not None and np.any(lacking):
            price = self._near_price * lacking
            rows = np.einsum("mf,mfr->mr", near.rates, z[near.knots])
            np.add.at(main, near.knots - 1, np.einsum("m,mr,ms->mrs", price, rows, rows))
            np.add.at(slope, near.knots, (price * near.room)[:, None] * near.rates)
        return (main, beside, second), gradient + np.einsum("ifr,if->ir", z, slope)[1:-1]


def _reduced(left: Array, price: Array, right: Array) -> Array:
    """L' diag(p) R of every knot: (N, f, r), (N, f), (N, f, s) -> (N, r, s)."""
    return np.asarray((left * price[:, :, None]).transpose(0, 2, 1) @ right)


def _beyond(values: Array, lower: Array, upper: Array) -> Array:
    """Sum (f,) over the rows of the squares of what values (N, f) are off their bounds."""
    over, under = values - upper, lower - values
    np.maximum(over, 0.0, out=over)
    np.maximum(under, 0.0, out=under)
    over += under
    over *= over
    return np.asarray(over.sum(axis=0))


def _second_differences(shares: Array) -> tuple[Array, Array, Array]:
    """Coefficients (N - 1,) of the root of a times h^2 q'' at the interior knots by three points; `shares`
    (N,) are the spacings in parts of h, the widest, and a (N - 1,) their means about a knot."""
    left, right = shares[:-1], shares[1:]
    root = np.sqrt(0.5 * (left + right))
    before, after = 1.0 / (root * left), 1.0 / (root * right)
    return before, -(before + after), after


def _solve_blocks(main: Array, beside: Array, second: Array, right: Array) -> Array:
    """Solve the symmetric block band system (diagonal, first, second blocks above) for right (M, r)."""
    count, r = right.shape
    above = 3 * r - 1
    band = np.zeros((above + 1, count * r))
    by_knot = band.reshape(above + 1, count, r)
    for offset, blocks in enumerate((main, beside, second)):
        row, column = np.indices((r, r)).reshape(2, -1)
        distance = offset * r + column - row
        row, column, distance = (part[distance >= 0] for part in (row, column, distance))
        by_knot[above - distance, offset:, column] = blocks[:, row, column].T
    solution = solveh_banded(band, right.reshape(-1), overwrite_ab=True, check_finite=False)
    return np.asarray(solution).reshape(count, r)
