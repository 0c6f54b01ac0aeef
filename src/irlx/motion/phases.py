"""Collects phases of a time law one after another."""

from __future__ import annotations

from math import fsum, inf

import numpy as np

from irlx.motion.phased_law import PhasedLaw


class Phases:
    """Phases from rest on; neighbours that are one motion become one phase."""

    def __init__(self) -> None:
        self._spans: list[float] = []
        self._ways: list[float] = []
        self._rates: list[float] = [0.0]
        self._starts: list[float] = []
        self._jerks: list[float] = []
        self._allowed: list[float] = []
        self._allowed_jerks: list[float] = []

    def add(
        self,
        span: float,
        way: float,
        rate: float,
        allowed: float,
        start: float = 0.0,
        jerk: float = 0.0,
        allowed_jerk: float = inf,
    ) -> None:
        """A phase of `span` s over `way` that ends at `rate`; nothing where it takes no time.

        It begins with the acceleration `start` and keeps `jerk`; `allowed` and `allowed_jerk` bound it.
        """
        if not (span > 0.0 and way > 0.0):
            return
        if (
            jerk == 0.0
            and self._jerks
            and self._jerks[-1] == 0.0
            and start == self._starts[-1]
            and allowed == self._allowed[-1]
            and allowed_jerk == self._allowed_jerks[-1]
        ):
            self._spans[-1] += span
            self._ways[-1] += way
            self._rates[-1] = rate
            return
        self._spans.append(span)
        self._ways.append(way)
        self._rates.append(rate)
        self._starts.append(start)
        self._jerks.append(jerk)
        self._allowed.append(allowed)
        self._allowed_jerks.append(allowed_jerk)

    def law(self, length: float) -> PhasedLaw:
        """The law of all phases; their ways, `length` but for rounding, are made to end exactly there."""
        ways = np.cumsum([0.0, *self._ways])
        ways *= length / fsum(self._ways)
        ways[-1] = length
        rates = np.array(self._rates)
        rates[-1] = 0.0
        return PhasedLaw(
            np.cumsum([0.0, *self._spans]),
            ways,
            rates,
            np.array(self._starts),
            np.array(self._jerks),
            np.array(self._allowed),
            np.array(self._allowed_jerks),
        )
