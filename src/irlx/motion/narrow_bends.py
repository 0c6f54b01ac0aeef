"""Sections of a curve about bends that are narrower than they: the tool is slow there alone."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.motion.largest_values import largest_values, samples_of
from irlx.motion.polynomial_curve import PolynomialCurve

Array = NDArray[np.float64]

_NARROW = 1.05
"""A bend is narrow where its curvature is more than so many times that of a section's even samples."""
_STEADY, _LEAST_TURN = 1.5, 0.02
"""Curvatures of a section whose ratio is larger are told apart, where it turns by more than so many rad."""
_ROUNDS = 30


def cuts_about_narrow_bends(curve: PolynomialCurve, cuts: Array) -> Array:
    """The cuts (M + 1,), parameters of a curve, with more between them if one of its bends is narrow."""
    for again in range(_ROUNDS):
        low, high = cuts[:-1], cuts[1:]
        peak, samples = largest_values(curve.curvature, low, high), samples_of(low, high)
        seen = curve.curvature(samples.ravel()).reshape(samples.shape)
        if not again and not np.any(peak > _NARROW * np.max(seen, axis=1)):
            break
        uneven = peak > _STEADY * np.min(seen, axis=1)
        split = uneven & (_turns(curve, cuts) > _LEAST_TURN)
        if not np.any(split):
            break
        cuts = np.sort(np.concatenate([cuts, 0.5 * (low + high)[split]]))
    return cuts


def _turns(curve: PolynomialCurve, cuts: Array) -> Array:
    """Angle (M,) by which the tangent turns in each section, rad, by way of its middle."""
    u = np.sort(np.concatenate([cuts, 0.5 * (cuts[:-1] + cuts[1:])]))
    along = curve.along(u)[0]
    across = np.linalg.norm(np.cross(along[:-1], along[1:]), axis=1)
    angles = np.arctan2(across, np.sum(along[:-1] * along[1:], axis=1))
    return np.asarray(angles[::2] + angles[1::2])
