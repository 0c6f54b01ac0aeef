"""Derivatives of the orientation exp(r) by those of its rotation vector r, and the way back."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_SERIES_BELOW = 0.05
"""Angle, rad, below which the factors are summed from their series: closed forms would cancel."""

_NEXT, _AFTER_NEXT = [1, 2, 0], [2, 0, 1]


def cross(a: Array, b: Array) -> Array:
    """Cross products of vectors (N, 3); on few of them several times as fast as numpy's."""
    return np.asarray(a[..., _NEXT] * b[..., _AFTER_NEXT] - a[..., _AFTER_NEXT] * b[..., _NEXT])


def angular_rates(r: Array, dr: Array, ddr: Array) -> tuple[Array, Array]:
    """Angular rate J dr of exp(r) and its derivative, each (N, 3), in the frame that r (N, 3) counts from.

    J dr = dr + a r x dr + b r x (r x dr), with a = (1 - cos t)/t^2, b = (t - sin t)/t^3, t = |r|.
    """
    a, b, da, db = _factors(r)
    turned, bent = cross(r, dr), cross(r, ddr)
    twice = cross(r, turned)
    growth = np.sum(r * dr, axis=-1, keepdims=True)
    drift = growth * (da * turned + db * twice) + b * cross(dr, turned)
    return dr + a * turned + b * twice, ddr + a * bent + b * cross(r, bent) + drift


def vector_rates(r: Array, rate: Array, bend: Array) -> tuple[Array, Array]:
    """The derivatives dr and ddr (N, 3) of r (N, 3) that give angular rates and their derivatives (N, 3)."""
    dr = _inverse(r, rate)
    drift = angular_rates(r, dr, np.zeros_like(r))[1]
    return dr, _inverse(r, bend - drift)


def _inverse(r: Array, rate: Array) -> Array:
    """dr (N, 3) with J dr = rate: rate - r x rate / 2 + c r x (r x rate), c = (1 - t/2 cot(t/2)) / t^2."""
    t2 = np.sum(r * r, axis=-1, keepdims=True)
    small = t2 < _SERIES_BELOW**2
    half = 0.5 * np.sqrt(np.where(small, 1.0, t2))
    closed = (1.0 - half / np.tan(half)) / (4.0 * half**2)
    series = 1 / 12 + t2 * (1 / 720 + t2 * (1 / 30240 + t2 / 1209600))
    turned = cross(r, rate)
    return np.asarray(rate - 0.5 * turned + np.where(small, series, closed) * cross(r, turned))


def _factors(r: Array) -> tuple[Array, Array, Array, Array]:
    """a, b and their derivatives by the angle t, divided by t, each (N, 1)."""
    t2 = np.sum(r * r, axis=-1, keepdims=True)
    small = t2 < _SERIES_BELOW**2
    series = (
        1 / 2 - t2 * (1 / 24 - t2 * (1 / 720 - t2 / 40320)),
        1 / 6 - t2 * (1 / 120 - t2 * (1 / 5040 - t2 / 362880)),
        -1 / 12 + t2 * (1 / 180 - t2 * (1 / 6720 - t2 / 453600)),
        -1 / 60 + t2 * (1 / 1260 - t2 * (1 / 60480 - t2 / 4989600)),
    )
    if np.all(small):
        return series
    t = np.sqrt(np.where(small, 1.0, t2))
    sine, versine = np.sin(t), 2.0 * np.sin(0.5 * t) ** 2
    closed = (
        versine / t**2,
        (t - sine) / t**3,
        (t * sine - 2.0 * versine) / t**4,
        (t * versine - 3.0 * (t - sine)) / t**5,
    )
    a, b, da, db = (np.where(small, near, far) for near, far in zip(series, closed, strict=True))
    return a, b, da, db
