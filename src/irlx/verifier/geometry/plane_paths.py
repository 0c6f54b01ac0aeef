"""The curve that a link is to stay on, rebuilt from its points: how far others are off it, and its way."""

from __future__ import annotations

import numpy as np

from irlx.streams.joint_stream import Floats
from irlx.verifier.geometry.bernstein import bernstein, nearest_parameters
from irlx.verifier.geometry.splines import natural_bends

AT_ONCE = 1_000_000
"""Distances between points and samples that are compared at once."""

FINEST = 0.008
"""Greatest length of a cell of the curve, m: where a point is sought first."""


class PlanePath:
    """A cubic spline over the chords of points (K, 2) m: natural at its ends, or closed.

    The parameter of piece k runs from k to k + 1; a closed one is laid three times round, the middle counts.
    """

    def __init__(self, points: Floats, closed: bool) -> None:
        self._closed = closed
        ends = np.concatenate([points, points[:1]]) if closed else points
        chord = np.diff(ends, axis=0)
        lengths = np.linalg.norm(chord, axis=1)
        second = _closed_bends(chord, lengths) if closed else natural_bends(ends, lengths)
        h2 = lengths[:, None] ** 2
        first = ends[:-1] + chord / 3.0 - h2 * (2.0 * second[:-1] + second[1:]) / 18.0
        last = ends[1:] - chord / 3.0 - h2 * (second[:-1] + 2.0 * second[1:]) / 18.0
        control = np.stack([ends[:-1], first, last, ends[1:]], axis=1)
        self._pieces = len(control)
        self._control = np.concatenate([control] * 3) if closed else control
        cells = np.maximum(16, np.ceil(1.5 * lengths / FINEST)).astype(int)
        parts = [np.arange(count) / count + k for k, count in enumerate(cells)]
        self._seeds = np.concatenate([*parts, [float(self._pieces)]]) + (self._pieces if closed else 0)
        # About a point where two pieces meet the wider cell of both.
        widths = np.concatenate([np.full(count, 1.0 / count) for count in cells])
        self._widths = np.maximum(np.append(widths, widths[0]), np.append(widths[-1], widths))
        self._samples = self._jet(self._seeds)[0]

    def beside(self, positions: Floats) -> tuple[Floats, Floats]:
        """Distances (R,) m of positions (R, 2) from the curve or its straight ends, and tangents (R, 2)."""
        together = max(1, AT_ONCE // len(self._seeds))
        found = [self._nearest(positions[k : k + together]) for k in range(0, len(positions), together)]
        return np.concatenate([one[0] for one in found]), np.concatenate([one[1] for one in found])

    def _nearest(self, positions: Floats) -> tuple[Floats, Floats]:
        squared = np.sum(positions**2, axis=1)[:, None] - 2.0 * positions @ self._samples.T
        index = np.argmin(squared + np.sum(self._samples**2, axis=1), axis=1)
        most = float(len(self._control))
        u = nearest_parameters(self._jet, positions, self._seeds[index], self._widths[index], most)
        points, rates, _ = self._jet(u)
        apart = np.linalg.norm(positions - points, axis=1)
        tangents = rates / np.linalg.norm(rates, axis=1, keepdims=True)
        for end, outwards in () if self._closed else ((0, -1.0), (self._pieces, 1.0)):
            point, rate, _ = self._jet(np.array([float(end)]))
            tangent = rate[0] / np.linalg.norm(rate[0])
            away = positions - point
            aside = np.abs(away @ np.array([-tangent[1], tangent[0]]))
            nearer = (outwards * (away @ tangent) > 0.0) & (aside < apart)
            apart, tangents = np.where(nearer, aside, apart), np.where(nearer[:, None], tangent, tangents)
        return apart, tangents

    def _jet(self, u: Floats) -> tuple[Floats, Floats, Floats]:
        piece = np.clip(u.astype(np.int64), 0, len(self._control) - 1)
        control, share = self._control[piece], u - piece
        point = np.einsum("rk,rkx->rx", bernstein(share, 3), control)
        rate = 3.0 * np.einsum("rk,rkx->rx", bernstein(share, 2), np.diff(control, axis=1))
        change = 6.0 * np.einsum("rk,rkx->rx", bernstein(share, 1), np.diff(control, n=2, axis=1))
        return point, rate, change


def _closed_bends(chord: Floats, lengths: Floats) -> Floats:
    """Second derivatives (K + 1, 2) at the points of a closed spline, the last those of the first.

    The rates m of neighbours by  m_k-1 / h + 2 m_k (1/h + 1/H) + m_k+1 / H = 3 (s / h + S / H),  where h, s
    and H, S are length and slope of the chords before and behind; then the bends from the rates.
    """
    count = len(lengths)
    slope = chord / lengths[:, None]
    behind, before = 1.0 / lengths, 1.0 / np.roll(lengths, 1)
    matrix = np.zeros((count, count))
    for k in range(count):
        matrix[k, k] = 2.0 * (before[k] + behind[k])
        matrix[k, k - 1] += before[k]
        matrix[k, (k + 1) % count] += behind[k]
    right = 3.0 * (slope * behind[:, None] + np.roll(slope, 1, axis=0) * before[:, None])
    rates = np.linalg.solve(matrix, right)
    following = np.roll(rates, -1, axis=0)
    bends = (6.0 * slope - 4.0 * rates - 2.0 * following) / lengths[:, None]
    return np.concatenate([bends, bends[:1]])
