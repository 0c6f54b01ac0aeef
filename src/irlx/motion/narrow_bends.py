"""Sections of a curve about bends that are narrower than they: the tool is slow there alone."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.motion.largest_values import largest_values, samples_of
from irlx.motion.polynomial_curve import POINT, PolynomialCurve

Array = NDArray[np.float64]

_NARROW = 1.05
"""A bend is narrow where its curvature is more than so many times that of a section's even samples."""
_STEADY, _LEAST_TURN = 1.5, 0.02
"""Curvatures of a section whose ratio is larger are told apart, where it would turn by more than so many rad
if all of it were as bent as its peak: the tool is as slow in all of it."""
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
        ways = np.diff(curve.length_at(cuts))
        split = uneven & (peak * ways > _LEAST_TURN) & (ways > POINT)
        if not np.any(split):
            break
        cuts = np.sort(np.concatenate([cuts, 0.5 * (low + high)[split]]))
    return cuts
