"""The quintic with given value, first and second derivative at both ends."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Jet(NamedTuple):
    """Value, first and second derivative of a curve at one place, each (N, d)."""

    value: Array
    rate: Array
    bend: Array


def quintic(start: Jet, end: Jet, width: float | Array) -> Array:
    """Coefficients (6, N, d), the highest power first, of the quintics over 0..`width` between two jets."""
    rate, bend = start.rate * width, 0.5 * start.bend * width**2
    value = end.value - start.value - rate - bend
    slope, curve = end.rate * width - rate - 2.0 * bend, 0.5 * (end.bend * width**2 - 2.0 * bend)
    cubic = 10.0 * value - 4.0 * slope + curve
    quartic = -15.0 * value + 7.0 * slope - 2.0 * curve
    fifth = 6.0 * value - 3.0 * slope + curve
    powers = [fifth / width**5, quartic / width**4, cubic / width**3, 0.5 * start.bend, start.rate]
    return np.stack(np.broadcast_arrays(*powers, start.value))
