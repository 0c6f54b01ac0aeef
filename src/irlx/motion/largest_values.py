"""The largest values of functions between two parameters, however narrow their peaks."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SAMPLES = 5
"""Even samples of a section, its ends among them."""

_ROUGH, _EXACT, _NOTHING = 0.02, 2e-5, 1e-9
"""Where more than `_ROUGH` of the largest value may lie between samples of a section it is looked at again
between each two of them; where its largest value may lie, from `_EXACT` on. `_NOTHING`, and so much of the
largest of all sections, is rounding."""
_FINER, _FINEST = 12, 1e-10
"""So many times at most, a peak of 1e-8 of a section is seen; none that is narrower than this part of the
parameters themselves: there a curve, too, is rounding."""


class Seen(NamedTuple):
    """Of M sections: the largest value of their samples (M,), and how much more may lie between these."""

    largest: Array
    between: Array

    @property
    def most(self) -> Array:
        """The largest value (M,) that may be."""
        return self.largest + self.between


def samples_of(low: Array, high: Array) -> Array:
    """Even parameters (M, SAMPLES) from `low` (M,) to `high` (M,)."""
    return np.asarray(low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, SAMPLES))


def seen_in(values: Array) -> Seen:
    """What values (M, SAMPLES) at even samples tell; a peak narrower than these are apart is missed."""
    # A parabola through three samples rises by at most 1/8 of their second difference between two of them.
    between = np.max(np.abs(np.diff(values, 2, axis=1)), axis=1) / 8.0
    return Seen(np.max(values, axis=1), between)


def largest_values(values_at: Callable[[Array], Array], low: Array, high: Array) -> Array:
    """Largest values (M,) between parameters low (M,) and high (M,), with what may lie between samples.

    `values_at` gives values (N,), none negative, at parameters (N,).
    """
    samples = samples_of(low, high)
    seen = seen_in(values_at(samples.ravel()).reshape(samples.shape))
    found, best = seen.most, seen.largest.copy()
    nothing = _NOTHING * found.max(initial=1.0)
    finest = _FINEST * max(np.max(np.abs(low), initial=0.0), np.max(np.abs(high), initial=0.0))
    # Of sections that are looked at again: which of the given ones they are parts of.
    section = np.arange(len(low))
    for _ in range(_FINER):
        may_hold_it = seen.most >= best[section]
        rough = seen.between > np.where(may_hold_it, _EXACT, _ROUGH) * seen.largest + nothing
        rough &= samples[:, -1] - samples[:, 0] > finest
        if not np.any(rough):
            break
        section = np.repeat(section[rough], SAMPLES - 1)
        samples = samples_of(samples[rough, :-1].ravel(), samples[rough, 1:].ravel())
        seen = seen_in(values_at(samples.ravel()).reshape(samples.shape))
        np.maximum.at(found, section, seen.most)
        np.maximum.at(best, section, seen.largest)
    return found
