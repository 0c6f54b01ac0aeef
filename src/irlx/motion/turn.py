"""How the orientation changes along a path: one turn about a fixed axis, or two through a via orientation."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]

HALF_TURN_MARGIN = 1e-6
"""A turn this close (rad) to half a turn has no defined axis."""

PAUSE = 0.5
"""Part of a turn's way over which its rate falls to zero towards a via orientation."""

_STEADY_RATE = 1.0 / (1.0 - 0.5 * PAUSE)


class Turning(Protocol):
    """Orientations over the share of a path, from 0 at its start to 1 at its end.

    `angle` (rad) is all that is turned; `peak_rate` and `peak_bend` (rad) are the largest lengths of the
    first and second derivative by the share. `widest` (rad) is the angle of the largest single turn.
    """

    @property
    def angle(self) -> float:
        """Angle turned on the whole way, rad."""
        ...

    @property
    def widest(self) -> float:
        """Angle of the largest turn about one axis, rad."""
        ...

    @property
    def peak_rate(self) -> float:
        """Largest angle per share, rad."""
        ...

    @property
    def peak_bend(self) -> float:
        """Largest change of the angle per share, per share, rad."""
        ...

    def rotations(self, share: Array) -> Array:
        """Orientations (N, 3, 3) at the shares (N,), the one at 1 exactly that of the end."""
        ...

    def rates(self, share: Array) -> Array:
        """Derivative by the share (N, 3): rotation vectors in the world frame."""
        ...

    def bends(self, share: Array) -> Array:
        """Derivative of `rates` by the share (N, 3)."""
        ...


@dataclass(frozen=True)
class Turn:
    """Turn about one fixed axis, the shorter way round: R(u) = R0 exp(u theta), u the share.

    theta is the rotation vector from R0 to R1 in the tool frame at the start; `start`, `end` (3, 3).
    """

    start: Array
    end: Array

    @cached_property
    def vector(self) -> Array:
        """Axis times angle in the tool frame at the start, (3,) rad; of the same orientation exactly 0."""
        if np.array_equal(self.start, self.end):
            return np.zeros(3)
        return np.asarray(Rotation.from_matrix(self.start.T @ self.end).as_rotvec())

    @cached_property
    def angle(self) -> float:
        """Angle between the orientations at the ends, rad, at most pi."""
        return float(np.linalg.norm(self.vector))

    @property
    def widest(self) -> float:
        """The same angle: there is but one turn."""
        return self.angle

    @property
    def peak_rate(self) -> float:
        """The angle, rad: the rate is the same everywhere."""
        return self.angle

    @property
    def peak_bend(self) -> float:
        """Zero: the rate does not change."""
        return 0.0

    def rotations(self, share: Array) -> Array:
        """Orientations (N, 3, 3) at the shares (N,), at 1 exactly `end`."""
        turned = Rotation.from_rotvec(share[:, None] * self.vector).as_matrix()
        rotation = np.asarray(self.start @ turned)
        rotation[share == 1.0] = self.end
        return rotation

    def rates(self, share: Array) -> Array:
        """Derivative by the share (N, 3): R0 theta, the same in the world frame at every share."""
        return np.tile(self.start @ self.vector, (len(share), 1))

    def bends(self, share: Array) -> Array:
        """Derivative of `rates`: zeros (N, 3)."""
        return np.zeros((len(share), 3))


@dataclass(frozen=True)
class TurnsThroughVia:
    """Two fixed-axis turns: `first` up to the share `via_share` (inside 0..1), `second` from there.

    Where two turns about different axes meet, the rate would jump, and with it every joint's speed. So it
    falls to zero before the via orientation and rises behind it: over the first half of its way `first`
    turns at a steady rate, over the second the rate falls linearly; `second` mirrors that.
    """

    first: Turn
    second: Turn
    via_share: float

    @property
    def angle(self) -> float:
        """Both angles together, rad."""
        return self.first.angle + self.second.angle

    @property
    def widest(self) -> float:
        """The larger of both angles, rad."""
        return max(self.first.angle, self.second.angle)

    @property
    def peak_rate(self) -> float:
        """Largest angle per share, rad: that of the steady parts."""
        steepest = max(self.first.angle / self.via_share, self.second.angle / (1.0 - self.via_share))
        return _STEADY_RATE * steepest

    @property
    def peak_bend(self) -> float:
        """Largest change of the rate per share, rad: that of the falling and rising parts."""
        ways = self.via_share, 1.0 - self.via_share
        return _STEADY_RATE / PAUSE * max(self.first.angle / ways[0] ** 2, self.second.angle / ways[1] ** 2)

    def rotations(self, share: Array) -> Array:
        """Orientations (N, 3, 3) at the shares (N,), at 1 exactly that of the end."""
        before, inward, outward = self._split(share)
        turned = self.second.rotations(1.0 - _slowing(outward)[0])
        turned[before] = self.first.rotations(_slowing(inward[before])[0])
        return turned

    def rates(self, share: Array) -> Array:
        """Derivative by the share (N, 3): rotation vectors in the world frame."""
        before, inward, outward = self._split(share)
        rates = self.second.rates(share) * (_slowing(outward)[1] / (1.0 - self.via_share))[:, None]
        first = self.first.rates(share) * (_slowing(inward)[1] / self.via_share)[:, None]
        return np.where(before[:, None], first, rates)

    def bends(self, share: Array) -> Array:
        """Derivative of `rates` (N, 3); at its jumps that of one side."""
        before, inward, outward = self._split(share)
        bends = self.second.rates(share) * (-_slowing(outward)[2] / (1.0 - self.via_share) ** 2)[:, None]
        first = self.first.rates(share) * (_slowing(inward)[2] / self.via_share**2)[:, None]
        return np.where(before[:, None], first, bends)

    def _split(self, share: Array) -> tuple[NDArray[np.bool_], Array, Array]:
        """Which shares lie before the via orientation; shares of the first and, backwards, the second way."""
        return share < self.via_share, share / self.via_share, (1.0 - share) / (1.0 - self.via_share)


def _slowing(way: Array) -> tuple[Array, Array, Array]:
    """Share turned (N,) at a share of the way that ends at rest, and its two derivatives.

    u = c x up to x = 1 - p, then u = 1 - c (1 - x)^2 / (2 p), with c = 1 / (1 - p/2), p = `PAUSE`.
    """
    left = 1.0 - way
    falling = left < PAUSE
    turned = np.where(falling, 1.0 - _STEADY_RATE / (2.0 * PAUSE) * left * left, _STEADY_RATE * way)
    rate = np.where(falling, _STEADY_RATE / PAUSE * left, _STEADY_RATE)
    return turned, rate, np.where(falling, -_STEADY_RATE / PAUSE, 0.0)
