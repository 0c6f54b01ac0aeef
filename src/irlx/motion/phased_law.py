"""Time law of phases with constant jerk: S curves, and motions whose bounds change along the path."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from irlx.motion.phase import shares_of_phases, swept

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PhasedLaw:
    """Motion from rest to rest in K phases, each of constant jerk.

    `times`, `ways`, `rates` (K + 1,): time, way and rate ds/dt at the ends of the phases, from 0; `starts`
    (K,): d2s/dt2 at the start of each phase; `jerks` (K,): d3s/dt3 in it. No phase changes the sign of its
    acceleration. `allowed` (K,): largest |d2s/dt2| that the program allows there, and
    `allowed_jerks` (K,) largest |d3s/dt3|, infinite where accelerations may jump.
    """

    times: Array
    ways: Array
    rates: Array
    starts: Array
    jerks: Array
    allowed: Array
    allowed_jerks: Array

    @property
    def length(self) -> float:
        """The whole way."""
        return float(self.ways[-1])

    @property
    def duration(self) -> float:
        """Time from rest to rest, s."""
        return float(self.times[-1])

    @cached_property
    def speed(self) -> float:
        """Largest rate: phases end where it is."""
        return float(np.max(self.rates))

    @cached_property
    def acc(self) -> float:
        """Largest |d2s/dt2|: that of one end of a phase."""
        ends = self.starts + self.jerks * np.diff(self.times)
        return float(max(np.max(np.abs(self.starts)), np.max(np.abs(ends))))

    @cached_property
    def corners(self) -> tuple[float, ...]:
        """Ways at which phases meet, both ends included."""
        return tuple(self.ways.tolist())

    def evaluate(self, t: Array) -> tuple[Array, Array]:
        """Way s and its rate ds/dt at the times t (N,), s from the start; constant outside [0, duration]."""
        t = np.clip(t, 0.0, self.duration)
        k = self._phase(self.times, t)
        # From the nearer end of the phase: at both ends the values are then exact.
        before, behind = t - self.times[k], self.times[k + 1] - t
        late = behind < before
        tau = np.where(late, -behind, before)
        base = k + late
        acc = self.starts[k] + np.where(late, self.jerks[k] * (self.times[k + 1] - self.times[k]), 0.0)
        way, rate = swept(self.rates[base], acc, self.jerks[k], tau)
        s = np.clip(self.ways[base] + way, self.ways[k], self.ways[k + 1])
        return s, np.clip(rate, 0.0, self.speed)

    def rates_at(self, s: Array) -> Array:
        """Rate ds/dt at the ways s (N,)."""
        return self._at(s)[1]

    def times_at(self, s: Array) -> Array:
        """Time at which each of the ways s (N,) is reached, s from the start."""
        return self._at(s)[0]

    def acc_at(self, s: Array) -> Array:
        """Largest |d2s/dt2| that the program allows at the ways s (N,); where phases meet the smaller one."""
        return self._smaller(self.allowed, s)

    def jerk_at(self, s: Array) -> Array:
        """Largest |d3s/dt3| that is allowed at the ways s (N,); where phases meet the smaller one."""
        return self._smaller(self.allowed_jerks, s)

    def stretched(self, duration: float) -> PhasedLaw:
        """Same shape in another time: every rate falls by the factor by which time grows."""
        factor = duration / self.duration
        times = self.times * factor
        times[-1] = duration
        return replace(
            self,
            times=times,
            rates=self.rates / factor,
            starts=self.starts / factor**2,
            jerks=self.jerks / factor**3,
            allowed=self.allowed / factor**2,
            allowed_jerks=self.allowed_jerks / factor**3,
        )

    def _at(self, s: Array) -> tuple[Array, Array]:
        """Time and rate at which the ways s (N,) are reached."""
        s = np.clip(s, 0.0, self.length)
        k = self._phase(self.ways, s)
        spans = np.diff(self.times)[k]
        ends = self.starts[k] + self.jerks[k] * spans
        # From the slower end every phase gains speed: its way is a convex function of time, and no root of a
        # small difference is taken next to standstill.
        back = self.rates[k + 1] < self.rates[k]
        way = np.where(back, self.ways[k + 1] - s, s - self.ways[k])
        rate = np.where(back, self.rates[k + 1], self.rates[k])
        acc = np.where(back, -ends, self.starts[k])
        tau = shares_of_phases(way, rate, acc, self.jerks[k], spans)
        rates = np.maximum(swept(rate, acc, self.jerks[k], tau)[1], 0.0)
        return np.where(back, self.times[k + 1] - tau, self.times[k] + tau), rates

    def _smaller(self, of_phases: Array, s: Array) -> Array:
        """Of values (K,) of the phases that of each way s (N,); where phases meet the smaller one."""
        s = np.clip(s, 0.0, self.length)
        left = np.clip(np.searchsorted(self.ways, s, side="left") - 1, 0, len(self.jerks) - 1)
        return np.asarray(np.minimum(of_phases[left], of_phases[self._phase(self.ways, s)]))

    def _phase(self, ends: Array, values: Array) -> NDArray[np.intp]:
        """Phase (N,) in which each of the values (N,) lies, between those at the ends of phases (K + 1,)."""
        return np.asarray(np.clip(np.searchsorted(ends, values, side="right") - 1, 0, len(self.jerks) - 1))
