"""One phase of constant jerk: its way by time, and its time by way."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_MOST_STEPS = 100


def swept(rate: Array, acc: Array, jerk: Array, tau: Array) -> tuple[Array, Array]:
    """Way and rate (N,) after the times `tau` (N,) from `rate` and `acc` with constant `jerk`."""
    way = tau * (rate + tau * (acc / 2.0 + tau * jerk / 6.0))
    return np.asarray(way), np.asarray(rate + tau * (acc + tau * jerk / 2.0))


def shares_of_phases(way: Array, rate: Array, acc: Array, jerk: Array, spans: Array) -> Array:
    """Times (N,) after which a `way` (N,) >= 0 is covered, within `spans` (N,).

    `rate` and the acceleration are >= 0 throughout. Closed form without jerk; else Newton's method from the
    right: the way is convex over time, so the steps fall monotonically to the root.
    """
    root = np.sqrt(rate * rate + 2.0 * np.maximum(acc, 0.0) * way)
    tau = np.divide(2.0 * way, rate + root, out=np.zeros_like(way), where=rate + root > 0.0)
    bent = np.flatnonzero((jerk != 0.0) & (way > 0.0))
    if bent.size:
        tau[bent] = _newton(way[bent], rate[bent], acc[bent], jerk[bent], spans[bent])
    return np.asarray(np.clip(tau, 0.0, spans))


def _newton(way: Array, rate: Array, acc: Array, jerk: Array, spans: Array) -> Array:
    # With rising acceleration every term alone bounds the time from above; 1E-3 covers their rounding.
    cubic = np.cbrt(6.0 * way / np.abs(jerk)) * (1.0 + 1e-3)
    tau = np.where(jerk > 0.0, np.minimum(spans, cubic), spans)
    for _ in range(_MOST_STEPS):
        gone, speed = swept(rate, acc, jerk, tau)
        step = np.divide(gone - way, speed, out=np.zeros_like(tau), where=speed > 0.0)
        following = np.clip(tau - step, 0.0, tau)
        if np.all(following >= tau * (1.0 - 4e-16)):
            break
        tau = following
    return np.asarray(tau)
