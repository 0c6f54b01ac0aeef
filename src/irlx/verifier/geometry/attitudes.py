"""How the tool's orientation goes along one move: a turn about a fixed axis, two of them, or a blend."""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from irlx.streams.joint_stream import Floats
from irlx.verifier.geometry.arcs import eased, eased_rates
from irlx.verifier.geometry.bernstein import bernstein, quintic_control
from irlx.verifier.geometry.paths import shortest_turns
from irlx.verifier.geometry.rotations import about_axis, cross_matrix, rotation_vectors

SAME_SHARE = 1e-9
"""Shares nearer to that of a via point than this are the same to rounding."""


class Turning(NamedTuple):
    """Orientation (3, 3) at a place, and by the way there its angular rate and the change of that, (3,), both
    in the root frame."""

    rotation: Floats
    rate: Floats
    change: Floats


class Attitude(Protocol):
    """Orientation along a move, by the share 0..1 of its way."""

    @property
    def angle(self) -> float:
        """Angle turned in all, rad."""

    def at(self, share: Floats) -> Floats:
        """Rotations (R, 3, 3) at shares (R,)."""

    def turnings(self, share: float) -> list[Turning]:
        """Orientation and its rates, by the share, at a share: where they jump on both sides of it."""


class SteadyTurn:
    """From one rotation (3, 3) to another about one fixed axis, the shorter way round, steadily."""

    def __init__(self, start: Floats, goal: Floats) -> None:
        self._start = start
        turn = shortest_turns(start, goal)[0]
        self.angle = float(np.linalg.norm(turn))
        self._axis = turn / self.angle if self.angle > 0.0 else np.array([1.0, 0.0, 0.0])

    def at(self, share: Floats) -> Floats:
        """Rotations (R, 3, 3) at shares (R,) of the way."""
        return np.asarray(self._start @ about_axis(self._axis, share * self.angle))

    def turnings(self, share: float) -> list[Turning]:
        """Orientation and its rates at a share."""
        rate = self._start @ self._axis * self.angle
        return [Turning(self.at(np.array([share]))[0], rate, np.zeros(3))]


class ViaTurn:
    """Over the orientation of a via point, which lies at a share of the way; eased to rest there."""

    def __init__(self, rotations: tuple[Floats, Floats, Floats], via: float) -> None:
        self._turns = SteadyTurn(rotations[0], rotations[1]), SteadyTurn(rotations[1], rotations[2])
        self._via = via

    @property
    def angle(self) -> float:
        """Angle of both turns, rad."""
        return self._turns[0].angle + self._turns[1].angle

    def at(self, share: Floats) -> Floats:
        """Rotations (R, 3, 3) at shares (R,) of the way."""
        to_via = self._turns[0].at(eased(np.clip(share / self._via, 0.0, 1.0)))
        left = np.clip((1.0 - share) / (1.0 - self._via), 0.0, 1.0)
        from_via = self._turns[1].at(1.0 - eased(left))
        return np.asarray(np.where((share < self._via)[:, None, None], to_via, from_via))

    def turnings(self, share: float) -> list[Turning]:
        """Orientation and its rates at a share; at the via point on both sides of it."""
        if abs(share - self._via) <= SAME_SHARE:
            return [self._turning(self._via, before) for before in (True, False)]
        return [self._turning(share, share < self._via)]

    def _turning(self, share: float, before: bool) -> Turning:
        whole = self._via if before else 1.0 - self._via
        rate, change = eased_rates(share / whole if before else (1.0 - share) / whole)
        along = self._turns[0 if before else 1].turnings(0.0)[0].rate
        sign = 1.0 if before else -1.0
        return Turning(self.at(np.array([share]))[0], along * rate / whole, sign * along * change / whole**2)


class BlendedTurn:
    """R = base exp(r), r a quintic of the way in 0..`length`, by orientation and rates at its ends."""

    def __init__(self, base: Floats, ends: tuple[Turning, Turning], length: float) -> None:
        self._base = base
        self._length = length
        start, end = (_vector(base, turning, length) for turning in ends)
        self._control = quintic_control(start, end)

    def at(self, share: Floats) -> Floats:
        """Rotations (R, 3, 3) at shares (R,) of the way."""
        return self._rotations(bernstein(share, 5) @ self._control)

    def turning(self, share: float) -> Turning:
        """Orientation and its rates, by the way, at a share of it."""
        at, rates = np.array([share]), 5.0 * np.diff(self._control, axis=0)
        r, dr = (bernstein(at, 5) @ self._control)[0], (bernstein(at, 4) @ rates)[0]
        ddr = (bernstein(at, 3) @ (4.0 * np.diff(rates, axis=0)))[0]
        inverse, moved = _chart(r, dr)
        rate = np.linalg.solve(inverse, dr)
        change = np.linalg.solve(inverse, ddr - moved @ rate)
        rotation = self._rotations(r[None])[0]
        return Turning(rotation, self._base @ rate / self._length, self._base @ change / self._length**2)

    def _rotations(self, vectors: Floats) -> Floats:
        angles = np.linalg.norm(vectors, axis=1)
        axes = vectors / np.where(angles > 0.0, angles, 1.0)[:, None]
        return np.asarray(self._base @ about_axes(axes, angles))


def about_axes(axes: Floats, angles: Floats) -> Floats:
    """Turns (N, 3, 3) about unit axes (N, 3) by angles (N,), rad: Rodrigues' formula."""
    k = np.zeros((len(axes), 3, 3))
    k[:, 0, 1], k[:, 0, 2], k[:, 1, 2] = -axes[:, 2], axes[:, 1], -axes[:, 0]
    k -= np.swapaxes(k, 1, 2)
    versine = 2.0 * np.sin(0.5 * angles) ** 2
    return np.asarray(np.eye(3) + np.sin(angles)[:, None, None] * k + versine[:, None, None] * (k @ k))


def _vector(base: Floats, turning: Turning, length: float) -> tuple[Floats, Floats, Floats]:
    """Rotation vector from `base`, its first and second derivative by the share of a way of a `length`."""
    r = rotation_vectors((base.T @ turning.rotation)[None])[0]
    rate, change = base.T @ turning.rate * length, base.T @ turning.change * length**2
    inverse, _ = _chart(r, np.zeros(3))
    dr = inverse @ rate
    return r, dr, inverse @ change + _chart(r, dr)[1] @ rate


def _chart(r: Floats, dr: Floats) -> tuple[Floats, Floats]:
    """L (3, 3) in r' = L w, w the rate of exp(r) in the frame that r counts from, and the derivative of L.

    L = 1 - [r]/2 + c [r]^2.
    """
    c, slope = _factors(float(np.linalg.norm(r)))
    hat, moved = cross_matrix(r), cross_matrix(dr)
    change = -0.5 * moved + c * (moved @ hat + hat @ moved) + slope * float(r @ dr) * hat @ hat
    return np.eye(3) - 0.5 * hat + c * hat @ hat, change


def _factors(angle: float) -> tuple[float, float]:
    """c = 1/t^2 - cot(t/2)/(2 t) of an angle t, and its derivative by t, divided by t."""
    if angle < 0.1:
        t2 = angle * angle
        c = 1.0 / 12.0 + t2 * (1.0 / 720.0 + t2 * (1.0 / 30240.0 + t2 / 1209600.0))
        return c, 1.0 / 360.0 + t2 * (1.0 / 7560.0 + t2 * (1.0 / 201600.0 + t2 / 5987520.0))
    half = 0.5 * angle
    cot = float(np.cos(half) / np.sin(half))
    slope = -2.0 / angle**3 + cot / (2.0 * angle**2) + 1.0 / (4.0 * angle * float(np.sin(half)) ** 2)
    return 1.0 / angle**2 - cot / (2.0 * angle), slope / angle
