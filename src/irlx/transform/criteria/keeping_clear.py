"""Keeping clear: the nearest points of the robot are led away from obstacles."""

from __future__ import annotations

from functools import cache
from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dgeqrf, dormqr

from irlx.scene.distances import Distances, Near
from irlx.scene.watched_pair import WatchedPair
from irlx.solids.shape import Point, Sphere
from irlx.transform.criteria.term import Term

Array = NDArray[np.float64]

OBSTACLE_WEIGHT = 0.7
"""a_obs: weight of the term, displacements in mm."""

POSTURE_WEIGHT = 0.3
"""a_conf: what is left of the posture term while an obstacle is near."""

_SQUARE_MILLIMETRES = 1e6
_STEP = 1e-3
"""alpha R (m2): a critical point that is R away from its obstacle moves on by 1000/R mm, R in mm, .."""

_PER_TIME = 0.05
""".. in each time (s) of this length."""

_FASTEST = 1.0
"""Joint speed (rad/s, m/s) that a push may ask for at the programmed pace."""

_SETTLING = 0.25
"""Part of the way out of its influence that a pair is pushed in 50 ms at most."""

_COUNTED = 0.25
"""Share of alpha up to which a pair counts the less the smaller it is."""

_NEAREST = 0.02
_RAMP = 0.25
_FALL = 4


class KeepingClear(Term):
    """Sum of w/2 a_obs |alpha v - J_k S|^2 over the pairs of a link and an obstacle within its influence.

    J_k (3, n) is the Jacobian of the link's nearest point, its critical point, v the unit vector away from
    the obstacle, alpha = 1e-3 m2 / R for every 50 ms of the way, R the distance (m; at least 20 mm).
    Displacements count in mm. Where one pair is near, w = 1: that is the criterion of Koch's monograph,
    section 7. Of several pairs at R_i that which is nearest, at R, counts most, w_i ~ (R / R_i)^4, all
    weights together as one; over the last quarter of the influence distance w rises from 0, so that nothing
    jumps. Where the tool's pose lets joints do little for it, alpha is less (`_shares`).

    A `calm` one is for motions that swing. There w rises with the fourth power of the way into the influence:
    a weight of 10^6 that rises faster throws a pair out, to fall back a tick later. Pairs for which joints
    can do next to nothing do not count: J_k S is what the path asks for there, and curved ways of the joints
    would only seem to change it. Where flat sides meet, alpha is less (`_gained`).
    """

    name = "keeping clear"

    def __init__(self, distances: Distances, free: NDArray[np.bool_], calm: bool = False) -> None:
        """Of the pairs of `distances`, joints moving that are `free` (n,)."""
        self._distances = distances
        self._kinematics = distances.kinematics
        self._free = free
        self._all_free = bool(np.all(free))
        self._pushing = np.array([pair.obstacle is not None for pair in distances.pairs], dtype=np.bool_)
        self._flat = np.array([not _is_round(pair) for pair in distances.pairs], dtype=np.bool_)
        self._calm = calm
        self._all_push = bool(np.all(self._pushing))
        self._influence = distances.influence.tolist()
        self._ramp = np.maximum(_RAMP * (distances.influence - distances.margin), 1e-12).tolist()
        self._q: Array | None = None
        self._found: tuple[Array, Array, float] | None = None

    def acts(self, q: Array) -> bool:
        """Whether an obstacle is near."""
        return not self._distances.far(q) and self._at(q)[2] > 0.0

    def posture_share(self, q: Array) -> float:
        """1 far from all obstacles, a_conf near one."""
        return 1.0 - (1.0 - POSTURE_WEIGHT) * self._at(q)[2]

    def linear(self, q: Array, elapsed: float) -> Array:
        """-sum w a_obs alpha J_k' v."""
        return self._at(q)[0] * (elapsed / _PER_TIME)

    def quadratic(self, q: Array) -> Array | None:
        """sum w a_obs J_k' J_k, shape (n, n)."""
        found = self._at(q)
        return found[1] if found[2] > 0.0 else None

    def _at(self, q: Array) -> tuple[Array, Array, float]:
        """b for 50 ms, B and the largest rise at posture q (n,)."""
        if self._found is None or self._q is not q:
            self._q, self._found = q, self._terms(q)
        return self._found

    def _terms(self, q: Array) -> tuple[Array, Array, float]:
        distances = self._distances
        near = distances.near(q)
        if not self._all_push:
            near = near.chosen(self._pushing[near.pairs])
        if not len(near.pairs):
            return np.zeros(q.size), np.zeros((q.size, q.size)), 0.0
        weights, alpha, highest = self._weights(near)
        points = distances.jacobians(q, near)
        opens = np.matmul(near.away[:, None, :], points)[:, 0, :]
        ways = self._ways(q, opens, points)
        if ways is None:
            return np.zeros(q.size), np.zeros((q.size, q.size)), highest
        shares = _shares(ways, alpha)
        if self._calm:
            weights = [w * min(share / _COUNTED, 1.0) for w, share in zip(weights, shares, strict=True)]
        pushed = np.array([w * a * share for w, a, share in zip(weights, alpha, shares, strict=True)])
        if self._calm:
            pushed = pushed * self._gained(q, near, opens, ways.basis.dot(pushed.dot(ways.rates)))
        rows = (np.sqrt(weights)[:, None, None] * points).reshape(-1, q.size)
        return -pushed.dot(opens), rows.T.dot(rows), highest

    def _weights(self, near: Near) -> tuple[list[float], list[float], float]:
        """w a_obs, 1/m2, and alpha, m, of each pair, and the largest rise. They are few: no arrays."""
        away = [max(distance, _NEAREST) for distance in near.distance.tolist()]
        nearest = min(away)
        rises, weights, alpha = [], [], []
        for pair, gap in zip(near.pairs.tolist(), away, strict=True):
            depth = max(self._influence[pair] - gap, 0.0)
            inside = min(depth / self._ramp[pair], 1.0)
            rise = inside * inside * (3.0 - 2.0 * inside)
            rises.append(rise)
            weights.append((rise * rise if self._calm else rise) * (nearest / gap) ** _FALL)
            # What leads out of the influence must not be thrown out of it, to fall back a tick later.
            alpha.append(min(_STEP / gap, _SETTLING * depth))
        scale = OBSTACLE_WEIGHT * _SQUARE_MILLIMETRES / max(sum(weights), 1.0)
        return [scale * weight for weight in weights], alpha, max(rises)

    def _ways(self, q: Array, opens: Array, points: Array) -> _Ways | None:
        """How joints open the gaps of pairs with the tool held at posture q; None where it holds them all.

        `opens` (P, n) is J_k' v of each pair, `points` (P, 3, n) its J_k.
        """
        jacobian = self._kinematics.rows_here(q)
        if not self._all_free:
            jacobian, points, opens = jacobian[:, self._free], points[:, :, self._free], opens[:, self._free]
        if jacobian.shape[1] <= jacobian.shape[0]:
            return None
        basis = _null_space(jacobian)
        rates = opens.dot(basis)
        moves = points.reshape(-1, len(basis)).dot(basis).reshape(len(rates), 3, -1)
        moved = np.matmul(moves, rates[:, :, None])[:, :, 0]
        return _Ways(basis, rates, _squares(rates), _squares(moved))

    def _gained(self, q: Array, near: Near, opens: Array, way: Array) -> Array:
        """The part of each pair's push (P,) that is worth it on the `way` of the free joints that all lead.

        Where a flat side lies along a straight one, the nearest point jumps from end to end: the end that is
        nearer is led away, and the other one comes nearer. So a push counts by what is gained of what it
        promises over the longest way of 50 ms, all of it from half of that on.
        """
        length = sqrt(way.dot(way))
        flat = self._flat[near.pairs]
        kept = np.ones(len(flat))
        if length <= 0.0 or not np.count_nonzero(flat):
            return kept
        step = np.zeros(q.size)
        step[self._free] = way * (_FASTEST * _PER_TIME / length)
        promised = opens[flat].dot(step)
        found = self._distances.of(q + step, near.pairs[flat]).distance - near.distance[flat]
        asked = promised > 0.0
        kept[flat] = np.where(asked, np.clip(2.0 * found / np.where(asked, promised, 1.0), 0.0, 1.0), 1.0)
        return kept


def _is_round(pair: WatchedPair) -> bool:
    """Whether the nearest points of two solids move on without a jump: one of them is a ball or a point."""
    return any(isinstance(solid.shape, Sphere | Point) for solid in (pair.solid, pair.other_solid))


class _Ways(NamedTuple):
    """How f free joints open the gaps of P pairs with the tool held: `basis` N (f, k) of its null space.

    `rates` g (P, k) = N' J_k' v, `gain` |g|^2 and `moved` |J_k N g|^2 of each.
    """

    basis: Array
    rates: Array
    gain: list[float]
    moved: list[float]


def _shares(ways: _Ways, alpha: list[float]) -> list[float]:
    """The part of alpha of each pair that counts: less than 1 where joints would have to move fast for it.

    In the null space the rate g = N' J_k' v opens the gap fastest; along g the sum is least for a step of
    alpha |g|^3 / |J_k N g|^2, which is kept below `_FASTEST` in 50 ms. A point next to the tool, which these
    joints hardly move, would else be worth any motion of them.
    """
    shares = []
    for most, gain, moved in zip(alpha, ways.gain, ways.moved, strict=True):
        asked, fastest = most * gain * sqrt(gain), _FASTEST * _PER_TIME * moved
        shares.append(fastest / max(asked, 1e-300) if asked > fastest else 1.0)
    return shares


def _squares(rows: Array) -> list[float]:
    return [sum([x * x for x in row]) for row in rows.tolist()]


def _null_space(jacobian: Array) -> Array:
    """The columns (n, n - m) of Q in J' = Q R that are orthogonal to all rows of J (m, n)."""
    m, n = jacobian.shape
    factors, scales, _, _ = dgeqrf(jacobian.T)
    return np.asarray(dormqr("L", "N", factors, scales, _last_columns(m, n), n)[0])


@cache
def _last_columns(m: int, n: int) -> Array:
    """Those of the identity (n, n) behind the first m."""
    return np.asfortranarray(np.eye(n)[:, m:])
