"""The curve of a SPLINE, rebuilt from its points: cubic pieces over the chords, turns from point to point."""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise

import numpy as np

from irlx.promises import PATH_POSITION
from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.geometry.attitudes import BlendedTurn, Turning
from irlx.verifier.geometry.bernstein import GAUSS, bernstein, nearest_parameters
from irlx.verifier.geometry.curves import Pose
from irlx.verifier.geometry.paths import shortest_turns

CELLS = 32
"""Parts of each piece by its parameter: where the nearest point is sought, and the length summed."""

TOGETHER, SPREAD = 32, 0.2
"""Rows sought together, and the part by which a way on the curve may differ from that from row to row."""

TRIED = 8
"""Cells tried for a row that is on the curve about none of the samples sought first."""

NEWTON, LAST_STEP = 12, 1e-13
"""Steps of Newton's method for the parameter at a way at most, and the step after which it ends."""

STEEPEST = 1.5
"""Rate of the turn at a point, over the smaller one of both sides: at most."""


class SplineCurve:
    """One smooth curve through K + 1 poses, no two neighbours of which have the same position.

    Piece by piece a cubic of the parameter u = k + (t - t_k) / c_k, t the length of the chords c. Position,
    tangent and curvature go on smoothly at the points; the curvature is 0 at both ends.
    """

    is_straight = False
    whole = np.inf

    def __init__(self, poses: list[Pose]) -> None:
        points = np.array([pose[0] for pose in poses])
        self._chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
        self._pieces = len(self._chords)
        second = natural_bends(points, self._chords)
        h2 = self._chords[:, None] ** 2
        # Control points of each cubic: from the values and second derivatives at its ends.
        chord = np.diff(points, axis=0)
        first = points[:-1] + chord / 3.0 - h2 * (2.0 * second[:-1] + second[1:]) / 18.0
        last = points[1:] - chord / 3.0 - h2 * (second[:-1] + 2.0 * second[1:]) / 18.0
        self._control = np.stack([points[:-1], first, last, points[1:]], axis=1)
        self._rate = 3.0 * np.diff(self._control, axis=1)
        self._change = 2.0 * np.diff(self._rate, axis=1)
        grid = np.linspace(0.0, self._pieces, self._pieces * CELLS + 1)
        between = self._length_between(grid[:-1], grid[1:])
        self._grid, self._ways = grid, np.concatenate([[0.0], np.cumsum(between)])
        self.length = float(self._ways[-1])
        self._knots = self._ways[::CELLS]
        self.room = 0.5 * float(self._knots[1]), 0.5 * float(self._knots[-1] - self._knots[-2])
        rotations = [pose[1] for pose in poses]
        steady = [shortest_turns(a, b)[0] for a, b in pairwise(rotations)]
        self.angle = float(sum(np.linalg.norm(turn) for turn in steady))
        self._turnings = _turnings(rotations, steady, np.diff(self._knots))

    def nearest(self, positions: Floats, near: float) -> Floats:
        """Way (R,) to the nearest points; before the start and behind the end along the tangents there."""
        before, found = self.points(np.array([near])), []
        for first in range(0, len(positions), TOGETHER):
            rows = positions[first : first + TOGETHER]
            seeds, due = self._seek(rows, near, before)
            found.append(self._found(rows, seeds, due))
            near, before = float(found[-1][-1]), rows[-1:]
        return np.concatenate(found) if found else np.zeros(0)

    def nearest_at_start(self, positions: Floats) -> Floats:
        """Way (R,) to the nearest points of the first piece; before its start along the tangent."""
        points = self._samples[: CELLS + 1]
        apart = np.sum((positions[:, None] - points) ** 2, axis=2)
        return self._nearest(positions, self._grid[np.argmin(apart, axis=1)])

    def _found(self, positions: Floats, seeds: Floats, due: Floats) -> Floats:
        """Way (R,) to the nearest points about the seeds; of rows that are on none of them to those about any
        cell, the nearest to where they are `due` (R,)."""
        way = self._nearest(positions, seeds)
        off = np.linalg.norm(positions - self.points(way), axis=1)
        for row in np.flatnonzero(off > PATH_POSITION).tolist():
            # In a narrow bend the nearest sample may be one of the other side, and beside a long piece one of
            # a short one: tried are the cells that may come nearest, by their samples and their length.
            apart = np.linalg.norm(positions[row] - self._samples, axis=1)
            least = np.minimum(apart[:-1], apart[1:]) - 0.5 * np.diff(self._ways)
            cells = np.argsort(least)[:TRIED]
            places = 0.5 * (self._grid[cells] + self._grid[cells + 1])
            other = self._nearest(np.repeat(positions[row : row + 1], len(cells), axis=0), places)
            apart = np.linalg.norm(positions[row] - self.points(other), axis=1)
            fits = np.flatnonzero(apart <= PATH_POSITION)
            if not fits.size:
                # Off the curve, and with it perhaps all that follow: these are not sought for ever.
                break
            way[row] = other[fits[np.argmin(np.abs(other[fits] - due[row]))]]
        return way

    def _nearest(self, positions: Floats, seeds: Floats) -> Floats:
        most = float(self._pieces)
        u = nearest_parameters(self._jet, positions, seeds, 1.0 / CELLS, most)
        way = self._way(u)
        for end, at in ((0.0, 0.0), (float(self._pieces), self.length)):
            here = u == end
            if here.any():
                beyond = (positions[here] - self._jet(u[here])[0]) @ self.tangents(np.array([at]))[0]
                way[here] += np.minimum(beyond, 0.0) if end == 0.0 else np.maximum(beyond, 0.0)
        return way

    def points(self, way: Floats) -> Floats:
        """Positions (R, 3)."""
        return self._jet(self._parameter(way))[0]

    def tangents(self, way: Floats) -> Floats:
        """Unit tangents (R, 3)."""
        rate = self._jet(self._parameter(way))[1]
        return np.asarray(rate / np.linalg.norm(rate, axis=1, keepdims=True))

    def bends(self, way: Floats) -> Floats:
        """Curvature vectors (R, 3)."""
        _, rate, change = self._jet(self._parameter(way))
        squared = np.sum(rate * rate, axis=1, keepdims=True)
        along = np.sum(rate * change, axis=1, keepdims=True) / squared
        return np.asarray((change - along * rate) / squared)

    def rotations(self, way: Floats) -> Floats:
        """Orientations (R, 3, 3)."""
        way = np.clip(way, 0.0, self.length)
        number = np.clip(np.searchsorted(self._knots, way, side="right") - 1, 0, self._pieces - 1)
        found = np.empty((len(way), 3, 3))
        for piece in np.unique(number).tolist():
            here = number == piece
            width = float(self._knots[piece + 1] - self._knots[piece])
            share = (way[here] - self._knots[piece]) / width
            found[here] = self._turn(piece, width).at(share)
        return found

    def turnings(self, way: float) -> list[Turning]:
        """Orientation and its rates by the way, at an end of which a blend takes over in the piece there."""
        piece = int(np.clip(np.searchsorted(self._knots, way, side="right") - 1, 0, self._pieces - 1))
        width = float(self._knots[piece + 1] - self._knots[piece])
        return [self._turn(piece, width).turning((way - float(self._knots[piece])) / width)]

    def _turn(self, piece: int, width: float) -> BlendedTurn:
        start, end = self._turnings[piece], self._turnings[piece + 1]
        return BlendedTurn(start.rotation, (start, end), width)

    def _seek(self, positions: Floats, near: float, before: Floats) -> tuple[Floats, Floats]:
        """Parameter of the sample nearest to each position, of those about as far on as the rows went, for
        the curve may cross itself; and the way at which the rows are due by that."""
        points = self._samples
        moved = np.cumsum(np.linalg.norm(np.diff(positions, axis=0, prepend=before), axis=1))
        due = np.clip(near + moved, 0.0, self.length)
        cell = np.clip(np.searchsorted(self._ways, due) - 1, 0, len(self._ways) - 2)
        slack = np.diff(self._ways)[cell] + SPREAD * moved
        apart = np.sum((positions[:, None] - points) ** 2, axis=2)
        apart = np.where(np.abs(self._ways - due[:, None]) > slack[:, None], np.inf, apart)
        return np.asarray(self._grid[np.argmin(apart, axis=1)]), due

    def _piece(self, u: Floats) -> tuple[Integers, Floats]:
        piece = np.clip(u.astype(np.int64), 0, self._pieces - 1)
        return piece, u - piece

    def _jet(self, u: Floats) -> tuple[Floats, Floats, Floats]:
        """Positions, first and second derivatives by u, each (R, 3)."""
        piece, share = self._piece(u)
        parts = ((3, self._control), (2, self._rate), (1, self._change))
        point, rate, change = (
            np.einsum("rk,rkx->rx", bernstein(share, degree), control[piece]) for degree, control in parts
        )
        return point, rate, change

    def _length_between(self, low: Floats, high: Floats) -> Floats:
        """Length (R,) between two parameters of one piece."""
        nodes, weights = GAUSS
        half = 0.5 * (high - low)
        piece, share = self._piece(low + half)
        shares = (share[:, None] + half[:, None] * nodes).ravel()
        control = np.repeat(self._rate[piece], len(nodes), axis=0)
        rate = np.einsum("rk,rkx->rx", bernstein(shares, 2), control)
        return np.asarray(half * (np.linalg.norm(rate, axis=1).reshape(len(low), -1) @ weights))

    def _way(self, u: Floats) -> Floats:
        cell = np.clip((u * CELLS).astype(np.int64), 0, len(self._grid) - 2)
        return np.asarray(self._ways[cell] + self._length_between(self._grid[cell], u))

    def _parameter(self, way: Floats) -> Floats:
        """Parameter u (R,) at ways (R,)."""
        u, inside = np.interp(way, self._ways, self._grid), np.clip(way, 0.0, self.length)
        for _ in range(NEWTON):
            rate = np.linalg.norm(self._jet(u)[1], axis=1)
            last = u
            u = np.clip(u - (self._way(u) - inside) / rate, 0.0, self._pieces)
            if not (np.abs(u - last) > LAST_STEP).any():
                break
        return np.asarray(u)

    @cached_property
    def _samples(self) -> Floats:
        return self._jet(self._grid)[0]


def natural_bends(points: Floats, chords: Floats) -> Floats:
    """Second derivatives (K + 1, 3), by the length of the chords (K,), of the cubic spline through points.

    At the ends they are 0; at inner points c_k M_k + 2 (c_k + c_k+1) M_k+1 + c_k+1 M_k+2 = 6 (rise of slope).
    """
    slopes = np.diff(points, axis=0) / chords[:, None]
    right = 6.0 * np.diff(slopes, axis=0)
    middle = 2.0 * (chords[:-1] + chords[1:])
    found = np.zeros_like(points)
    for k in range(1, len(right)):
        share = chords[k] / middle[k - 1]
        middle[k] -= share * chords[k]
        right[k] -= share * right[k - 1]
    for k in range(len(right) - 1, -1, -1):
        found[k + 1] = (right[k] - chords[k + 1] * found[k + 2]) / middle[k]
    return found


def _turnings(rotations: list[Floats], turns: list[Floats], widths: Floats) -> list[Turning]:
    """Orientation and its rate at each point: the mean of both sides, each by the length of the other, but at
    most `STEEPEST` times the smaller; 0 where the turn goes back. At the ends the rate is the steady one."""
    steady = [start @ turn / width for start, turn, width in zip(rotations[:-1], turns, widths, strict=True)]
    rates = [steady[0]]
    for k in range(1, len(steady)):
        before, behind = steady[k - 1], steady[k]
        mean = (widths[k] * before + widths[k - 1] * behind) / (widths[k - 1] + widths[k])
        size, most = float(np.linalg.norm(mean)), STEEPEST * min(map(np.linalg.norm, (before, behind)))
        rates.append(np.zeros(3) if before @ behind <= 0.0 else mean * min(1.0, float(most) / size))
    rates.append(steady[-1])
    return [Turning(rotation, rate, np.zeros(3)) for rotation, rate in zip(rotations, rates, strict=True)]
