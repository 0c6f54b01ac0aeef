"""Derivatives of the orientation exp(r) by those of its rotation vector r, and the way back."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_SERIES_BELOW = 0.05
"""Angle, rad, below which the factors are summed from their series: closed forms would cancel."""


def angular_rate(r: Array, dr: Array) -> Array:
    """Angular rate (N, 3) of exp(r) in the frame that r counts from: J dr.

    J dr = dr + a r x dr + b r x (r x dr), with a = (1 - cos t)/t^2, b = (t - sin t)/t^3, t = |r|.
    """
    a, b, _, _ = _factors(r)
    turned = np.cross(r, dr)
    return np.asarray(dr + a * turned + b * np.cross(r, turned))


def angular_bend(r: Array, dr: Array, ddr: Array) -> Array:
    """Derivative (N, 3) of `angular_rate` along the curve r with the derivatives dr and ddr."""
    return np.asarray(angular_rate(r, ddr) + _drift(r, dr))


def vector_rates(r: Array, rate: Array, bend: Array) -> tuple[Array, Array]:
    """The derivatives dr and ddr (3,) of r (3,) that give an angular rate and its derivative (3,)."""
    columns = np.eye(3)
    jacobian = angular_rate(np.tile(r, (3, 1)), columns).T
    dr = np.linalg.solve(jacobian, rate)
    ddr = np.linalg.solve(jacobian, bend - _drift(r[None], dr[None])[0])
    return dr, ddr


def _drift(r: Array, dr: Array) -> Array:
    """What of the derivative of J dr comes from the change of J."""
    _, b, da, db = _factors(r)
    turned = np.cross(r, dr)
    twice = np.cross(r, turned)
    growth = np.sum(r * dr, axis=-1, keepdims=True)
    return np.asarray(growth * (da * turned + db * twice) + b * np.cross(dr, turned))


def _factors(r: Array) -> tuple[Array, Array, Array, Array]:
    """a, b and their derivatives by the angle t, divided by t, each (N, 1)."""
    t2 = np.sum(r * r, axis=-1, keepdims=True)
    small = t2 < _SERIES_BELOW**2
    t = np.sqrt(np.where(small, 1.0, t2))
    sine, versine = np.sin(t), 2.0 * np.sin(0.5 * t) ** 2
    closed = (
        versine / t**2,
        (t - sine) / t**3,
        (t * sine - 2.0 * versine) / t**4,
        (t * versine - 3.0 * (t - sine)) / t**5,
    )
    series = (
        1 / 2 - t2 * (1 / 24 - t2 * (1 / 720 - t2 / 40320)),
        1 / 6 - t2 * (1 / 120 - t2 * (1 / 5040 - t2 / 362880)),
        -1 / 12 + t2 * (1 / 180 - t2 * (1 / 6720 - t2 / 453600)),
        -1 / 60 + t2 * (1 / 1260 - t2 * (1 / 60480 - t2 / 4989600)),
    )
    a, b, da, db = (np.where(small, near, far) for near, far in zip(series, closed, strict=True))
    return a, b, da, db
