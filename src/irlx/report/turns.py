"""How far orientations are turned from each other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["angles_between"]

Array = NDArray[np.float64]


def angles_between(before: Array, after: Array) -> Array:
    """Angles (M,) rad between orientations as unit quaternions (M, 4), whatever their signs.

    Of quaternions p, q the angle between is 4 asin(|p - q| / 2), for the sign of q that is nearer.
    """
    apart = np.minimum(np.linalg.norm(after - before, axis=1), np.linalg.norm(after + before, axis=1))
    return np.asarray(4.0 * np.arcsin(np.minimum(0.5 * apart, 1.0)))
