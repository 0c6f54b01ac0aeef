"""Orientation along a smooth curve: the rotation vector from fixed orientations is a quintic of s."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.motion.hermite import Jet, quintic
from irlx.motion.rotation_vector import angular_rates, vector_rates

if TYPE_CHECKING:
    from scipy.interpolate import PPoly

Array = NDArray[np.float64]


class TurnJet(NamedTuple):
    """Orientation (3, 3) at a place, its angular rate by s and the change of that by s, world, each (3,)."""

    rotation: Array
    rate: Array
    bend: Array


@dataclass(frozen=True)
class TurnCurve:
    """Orientation over s in K pieces: R(s) = base_k exp(r_k(s - breaks_k)).

    `breaks` (K + 1,) in units of s, `bases` (K, 3, 3), `coefficients` (6, K, 3) of the quintics r_k, the
    highest power first.
    """

    breaks: Array
    bases: Array
    coefficients: Array

    @classmethod
    def through(cls, breaks: Array, bases: Array, jets: list[tuple[TurnJet, TurnJet]]) -> TurnCurve:
        """Curve whose pieces have the given jets at their ends; a piece turns less than pi from its base."""
        if all(_rests(base, jet) for base, pair in zip(bases, jets, strict=True) for jet in pair):
            return cls(breaks, bases, np.zeros((6, len(bases), 3)))
        start, end = (_vector_jets(bases, [jet[side] for jet in jets]) for side in (0, 1))
        return cls(breaks, bases, quintic(start, end, np.diff(breaks)[:, None]))

    @cached_property
    def rests(self) -> bool:
        """Whether nothing turns: most blends lie between moves that keep the orientation."""
        return not self.coefficients.any()

    @property
    def widest(self) -> float:
        """Angle of the largest turn from the start of a piece to its end, rad."""
        if self.rests:
            return 0.0
        ends = np.array([self._curve(last) for last in np.nextafter(self.breaks[1:], -np.inf)])
        starts = self.coefficients[-1]
        turned = Rotation.from_rotvec(starts).inv() * Rotation.from_rotvec(ends)
        return float(np.max(turned.magnitude()))

    def rotations(self, s: Array) -> Array:
        """Orientations (N, 3, 3) at s (N,)."""
        if self.rests:
            return np.asarray(self.bases[self._piece(s)])
        vectors = Rotation.from_rotvec(self._curve(s)).as_matrix()
        return np.asarray(self.bases[self._piece(s)] @ vectors)

    def rates(self, s: Array) -> tuple[Array, Array]:
        """Angular rate by s, a rotation vector in the world frame, and its derivative by s, each (N, 3)."""
        if self.rests:
            return np.zeros((len(s), 3)), np.zeros((len(s), 3))
        rate, bend = angular_rates(self._curve(s), self._slope(s), self._bend(s))
        bases = self.bases[self._piece(s)]
        return (bases @ rate[:, :, None])[:, :, 0], (bases @ bend[:, :, None])[:, :, 0]

    def _piece(self, s: Array) -> NDArray[np.intp]:
        return np.clip(np.searchsorted(self.breaks, s, side="right") - 1, 0, len(self.bases) - 1)

    @cached_property
    def _curve(self) -> PPoly:
        from scipy.interpolate import PPoly

        return PPoly(self.coefficients, self.breaks)

    @cached_property
    def _slope(self) -> PPoly:
        return self._curve.derivative(1)

    @cached_property
    def _bend(self) -> PPoly:
        return self._curve.derivative(2)


def _rests(base: Array, jet: TurnJet) -> bool:
    return not (jet.rate.any() or jet.bend.any()) and np.array_equal(base, jet.rotation)


def _vector_jets(bases: Array, jets: list[TurnJet]) -> Jet:
    """Rotation vectors (K, 3) from the bases (K, 3, 3) with their derivatives."""
    to_base = np.transpose(bases, (0, 2, 1))
    vectors = np.asarray(Rotation.from_matrix(to_base @ np.array([jet.rotation for jet in jets])).as_rotvec())
    rates, bends = (
        (to_base @ np.array(parts)[:, :, None])[:, :, 0]
        for parts in ([jet.rate for jet in jets], [jet.bend for jet in jets])
    )
    return Jet(vectors, *vector_rates(vectors, rates, bends))
