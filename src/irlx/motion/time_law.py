"""Interface of time laws: which way of a path is due at which time."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LEAST_RATE = 1e-100
"""A speed or acceleration below is standstill: the products of a time law with it would round to 0."""


class TimeLaw(Protocol):
    """Motion from rest to rest over `length`, in the units of the path (m, rad, or 1) and seconds.

    The way never falls; before the start it is 0, behind the end exactly `length`.
    """

    @property
    def length(self) -> float:
        """The whole way."""
        ...

    @property
    def speed(self) -> float:
        """Largest rate ds/dt."""
        ...

    @property
    def acc(self) -> float:
        """Largest |d2s/dt2|."""
        ...

    @property
    def duration(self) -> float:
        """Time from rest to rest, s."""
        ...

    @property
    def corners(self) -> tuple[float, ...]:
        """Ways at which the law changes its form, both ends included, rising."""
        ...

    def rates_at(self, s: Array) -> Array:
        """Rate ds/dt at the ways s (N,)."""
        ...

    def times_at(self, s: Array) -> Array:
        """Time at which each of the ways s (N,) is reached, s from the start."""
        ...

    def acc_at(self, s: Array) -> Array:
        """Largest |d2s/dt2| that is allowed at the ways s (N,)."""
        ...

    def jerk_at(self, s: Array) -> Array:
        """Largest |d3s/dt3| that is allowed at the ways s (N,); infinite where the law bounds none."""
        ...

    def stretched(self, duration: float) -> TimeLaw:
        """Same shape in another time (s, > 0): every rate falls by the factor by which time grows."""
        ...

    def evaluate(self, t: Array) -> tuple[Array, Array]:
        """Way s and its rate ds/dt at the times t (N,), s from the start; constant outside [0, duration]."""
        ...
