"""The join that rounds a corner between two curves: a quintic from one to the other."""

from __future__ import annotations

from functools import cached_property
from itertools import product

import numpy as np
from numpy.typing import NDArray

from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.geometry.allowance import EXACT, Allowance
from irlx.verifier.geometry.attitudes import BlendedTurn
from irlx.verifier.geometry.bernstein import GAUSS, Jets, bernstein, nearest_parameters, quintic_control
from irlx.verifier.geometry.curves import Curve

CELLS, MOST_TURN, HALVINGS = 32, 0.5, 24
"""Parts of a join by its parameter: where the nearest point is sought, and the length summed. Those in which
it turns by more than `MOST_TURN` rad are halved, up to so many times."""

ON_IT = 1e-12
"""Rows so near to the point that was found, m, lie there."""

TANGENTS = np.linspace(0.75, 1.45, 15)
"""First derivatives by the parameter at both ends that a join may have, as parts of the circular arc between
them; it has the one with which the largest curvature, at 33 even values of the parameter, is the least."""

EVEN_TANGENT, TIE = 0.9, 1e-6
"""Where curvatures are alike the tangent nearest to this one counts: being off it by 1 weighs as much as a
curvature of `TIE`/arc."""


class Blend:
    """From `distance` m before the end of a curve to as far behind the start of the next one.

    Position, tangent and curvature are those of the curves at its ends, and so are the orientation and its
    rates. It runs by a parameter u in 0..1, the orientation by the share of its length.
    """

    def __init__(self, first: Curve, second: Curve, distance: float, tangents: Floats = TANGENTS) -> None:
        self.distance = distance
        self._ways = first.length - distance, distance
        self._curves = first, second
        self._corner = second.points(np.zeros(1))
        start, end = (_jet(curve, way) for curve, way in zip(self._curves, self._ways, strict=True))
        self._control = _flattest(start, end, tangents)
        self._rate = 5.0 * np.diff(self._control, axis=0)
        self._change = 4.0 * np.diff(self._rate, axis=0)

    def points(self, u: Floats) -> Floats:
        """Positions (R, 3), m."""
        return np.asarray(bernstein(u, 5) @ self._control)

    def curvature(self, u: Floats) -> Floats:
        """Curvature (R,), 1/m."""
        return curvature(bernstein(u, 4) @ self._rate, bernstein(u, 3) @ self._change)

    def nearest(self, positions: Floats) -> Floats:
        """Parameter (R,) of the point nearest to each position (R, 3)."""
        samples, points = self._samples
        apart = np.sum((positions[:, None] - points) ** 2, axis=2)
        nearest = np.argmin(apart, axis=1)
        if len(samples) == CELLS + 1:
            return nearest_parameters(self._jet_at, positions, samples[nearest], 1.0 / CELLS, 1.0)
        cells = np.diff(samples)
        widths = np.maximum(np.append(cells, 0.0), np.insert(cells, 0, 0.0))[nearest]
        found = nearest_parameters(self._jet_at, positions, samples[nearest], widths, 1.0)
        # In a narrow bend the nearest sample may be one of the other side, or where the join crosses itself.
        off = np.linalg.norm(positions - self.points(found), axis=1)
        elsewhere = self._beyond(positions, found) & (off > 0.5 * np.max(np.diff(self._lengths)))
        unsure = np.flatnonzero((off > ON_IT) & ~elsewhere)
        if unsure.size:
            least = np.sqrt(np.minimum(apart[unsure, :-1], apart[unsure, 1:])) - 0.5 * np.diff(self._lengths)
            rows, there = np.nonzero(least < off[unsure, None])
            self._seek_in(there, unsure[rows], positions, found, off)
        return found

    def _beyond(self, positions: Floats, u: Floats) -> NDArray[np.bool_]:
        """Which positions (R, 3), nearest to its points at u (R,), lie before its start or behind its end.

        They may still be near another of its points, but for those that no sample is near.
        """
        before = (positions - self._control[0]) @ self._rate[0] < 0.0
        return np.asarray(((u <= 0.0) & before) | ((u >= 1.0) & (self.behind(positions) > 0.0)))

    def _seek_in(
        self, cells: Integers, rows: Integers, positions: Floats, found: Floats, off: Floats
    ) -> None:
        """Enter where rows (N,) come nearer in cells (N,) than where they are `found` (R,), `off` (R,)."""
        samples = self._samples[0]
        middles, halves = 0.5 * (samples[1:] + samples[:-1])[cells], 0.5 * np.diff(samples)[cells]
        other = nearest_parameters(self._jet_at, positions[rows], middles, halves, 1.0)
        apart = np.linalg.norm(positions[rows] - self.points(other), axis=1)
        # The last one that is entered for a row counts: the nearest one.
        order = np.argsort(apart)[::-1]
        order = order[apart[order] < off[rows[order]]]
        found[rows[order]] = other[order]

    def behind(self, positions: Floats) -> Floats:
        """How far (R,) positions lie behind the plane across its end, m; negative before it."""
        forward = self._rate[-1] / np.linalg.norm(self._rate[-1])
        return np.asarray((positions - self._control[-1]) @ forward)

    @property
    def length(self) -> float:
        """Length, m."""
        return float(self._lengths[-1])

    @cached_property
    def corner(self) -> float:
        """Parameter of the point nearest to the corner: there the next move takes over."""
        return float(self.nearest(self._corner)[0])

    def way(self, u: Floats) -> Floats:
        """Length (R,) from its start to u (R,), m."""
        samples = self._samples[0]
        cell = np.minimum(np.searchsorted(samples, u, side="right"), len(samples) - 1) - 1
        return np.asarray(self._lengths[cell] + self._length_between(samples[cell], u))

    def turned_off(self, u: Floats, attitudes: Floats, allowance: Allowance = EXACT) -> Floats:
        """Angle (R,) rad between attitudes (R, ..) and the orientation at u (R,), beyond an allowance.

        Where the rates of a curve jump just where the blend begins or ends, it may take up either.
        """
        share = np.clip(self.way(u) / self.length, 0.0, 1.0)
        off = [allowance.turned_off(attitudes, turn.at(share)) for turn in self._turns]
        return np.asarray(np.min(off, axis=0))

    def rotations(self, u: Floats) -> Floats:
        """Orientations (R, 3, 3) at u (R,); where there are several, one of them."""
        return self._turns[0].at(np.clip(self.way(u) / self.length, 0.0, 1.0))

    @cached_property
    def _turns(self) -> list[BlendedTurn]:
        base = self._curves[1].turnings(0.0)[0].rotation
        starts, ends = (curve.turnings(way) for curve, way in zip(self._curves, self._ways, strict=True))
        return [BlendedTurn(base, pair, self.length) for pair in product(starts, ends)]

    def _jet_at(self, u: Floats) -> Jets:
        return self.points(u), bernstein(u, 4) @ self._rate, bernstein(u, 3) @ self._change

    def _length_between(self, low: Floats, high: Floats) -> Floats:
        """Length (R,) between two parameters by Gauss and Legendre."""
        nodes, weights = GAUSS
        half = 0.5 * (high - low)
        u = (low + half)[:, None] + half[:, None] * nodes
        rate = bernstein(u.ravel(), 4) @ self._rate
        return np.asarray(half * (np.linalg.norm(rate, axis=1).reshape(u.shape) @ weights))

    @cached_property
    def _samples(self) -> tuple[Floats, Floats]:
        u = np.linspace(0.0, 1.0, CELLS + 1)
        for _ in range(HALVINGS):
            rates = bernstein(u, 4) @ self._rate
            sizes = np.linalg.norm(rates, axis=1)
            cosines = np.sum(rates[1:] * rates[:-1], axis=1)
            sharp = cosines < np.cos(MOST_TURN) * sizes[1:] * sizes[:-1]
            if not sharp.any():
                break
            u = np.sort(np.concatenate([u, 0.5 * (u[1:] + u[:-1])[sharp]]))
        return u, self.points(u)

    @cached_property
    def _lengths(self) -> Floats:
        u = self._samples[0]
        return np.concatenate([[0.0], np.cumsum(self._length_between(u[:-1], u[1:]))])


def curvature(rate: Floats, change: Floats) -> Floats:
    """Curvature (..), 1/m, by first and second derivatives (.., 3); infinite where the first is 0."""
    speed = np.linalg.norm(rate, axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        found = np.linalg.norm(np.cross(rate, change), axis=-1) / speed**3
    return np.where(np.isfinite(found), found, np.inf)


def _jet(curve: Curve, way: float) -> tuple[Floats, Floats, Floats]:
    """Position, tangent and curvature (3,) of a curve at a place."""
    at = np.array([way])
    return curve.points(at)[0], curve.tangents(at)[0], curve.bends(at)[0]


def _flattest(
    start: tuple[Floats, Floats, Floats], end: tuple[Floats, Floats, Floats], tangents: Floats
) -> Floats:
    """Control points (6, 3) of the join with that of some tangents (T,) whose largest curvature is least."""
    half = 0.5 * float(np.arctan2(np.linalg.norm(np.cross(start[1], end[1])), start[1] @ end[1]))
    arc = float(np.linalg.norm(end[0] - start[0])) / float(np.sinc(half / np.pi))
    found = np.stack(
        [
            quintic_control(*((jet[0], size * jet[1], size**2 * jet[2]) for jet in (start, end)))
            for size in tangents * arc
        ]
    )
    rates = 5.0 * np.diff(found, axis=1)
    largest = np.max(curvature(_RATES @ rates, _CHANGES @ (4.0 * np.diff(rates, axis=1))), axis=1)
    return np.asarray(found[np.argmin(largest + TIE / arc * np.abs(tangents - EVEN_TANGENT))])


_RATES, _CHANGES = (bernstein(np.linspace(0.0, 1.0, 33), degree) for degree in (4, 3))
