"""Trapezoidal time law: constant acceleration, cruise, constant deceleration."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Trapezoid:
    """Motion from rest to rest over `length` that peaks at `speed`, ramps of `ramp` s, cruise of `cruise` s.

    Units of `length` are the path's: m, rad, or 1; time in s.
    """

    length: float
    speed: float
    ramp: float
    cruise: float

    @classmethod
    def fastest(cls, length: float, speed: float, acc: float) -> Trapezoid:
        """Shortest law within the bounds `speed` and `acc` (> 0); a triangle where the way is short."""
        if speed * speed >= length * acc:
            peak = sqrt(length * acc)
            return cls(length, peak, peak / acc, 0.0)
        return cls(length, speed, speed / acc, length / speed - speed / acc)

    @property
    def duration(self) -> float:
        """Time from rest to rest, s."""
        return 2.0 * self.ramp + self.cruise

    @property
    def acc(self) -> float:
        """Acceleration of the ramps, per s2."""
        return self.speed / self.ramp if self.ramp > 0.0 else 0.0

    @property
    def corners(self) -> tuple[float, ...]:
        """Ways at which the law changes from ramp to cruise to ramp, both ends included."""
        risen = 0.5 * self.speed * self.ramp
        inner = (risen, self.length - risen) if self.cruise > 0.0 else (0.5 * self.length,)
        return (0.0, *inner, self.length)

    def rates_at(self, s: Array) -> Array:
        """Rate ds/dt at the ways s (N,); on the ramps sqrt(2 acc s)."""
        nearest_end = np.clip(np.minimum(s, self.length - s), 0.0, None)
        return np.asarray(np.minimum(np.sqrt(2.0 * self.acc * nearest_end), self.speed))

    def times_at(self, s: Array) -> Array:
        """Time at which each of the ways s (N,) is reached, s from the start."""
        acc, risen = self.acc, 0.5 * self.speed * self.ramp
        up = np.sqrt(2.0 * np.clip(s, 0.0, risen) / acc)
        flat = (np.clip(s, risen, self.length - risen) - risen) / self.speed
        down = np.sqrt(2.0 * np.clip(self.length - s, 0.0, risen) / acc)
        return np.asarray(up + flat + self.ramp - down)

    def acc_at(self, s: Array) -> Array:
        """Largest |d2s/dt2| that is allowed at the ways s (N,): that of the ramps."""
        return np.full(np.shape(s), self.acc)

    def jerk_at(self, s: Array) -> Array:
        """Largest |d3s/dt3| that is allowed at the ways s (N,): its acceleration jumps."""
        return np.full(np.shape(s), np.inf)

    def stretched(self, duration: float) -> Trapezoid:
        """Same shape in another time: every speed falls by the factor by which time grows."""
        factor = duration / self.duration
        return Trapezoid(self.length, self.speed / factor, self.ramp * factor, self.cruise * factor)

    def evaluate(self, t: Array) -> tuple[Array, Array]:
        """Way s and its rate ds/dt at the times t (N,), s from the start; constant outside [0, duration]."""
        t = np.clip(t, 0.0, self.duration)
        left = self.duration - t
        up = 0.5 * self.acc * t * t
        flat = 0.5 * self.speed * self.ramp + self.speed * (t - self.ramp)
        down = self.length - 0.5 * self.acc * left * left
        s = np.where(t <= self.ramp, up, np.where(left <= self.ramp, down, flat))
        rate = np.minimum(np.minimum(self.acc * t, self.acc * left), self.speed)
        return np.where(left == 0.0, self.length, s), rate
