"""The twists that lead from many poses to as many others at once."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

Array = NDArray[np.float64]
RowsLast = tuple[Array, Array]
"""Rotations (3, 3, N) and positions (3, N) m: the row is the last index."""

_SERIES_BELOW = 0.5
"""Angle, rad, below which a factor is summed from its series: the closed form would cancel."""
_FEW_TERMS_BELOW = 1e-3
_WIDE = -0.5
"""Cosine of the angle from which the axis no longer comes well from the skew part of a rotation."""
_LEAST = 1e-9
"""Angle, rad, that is its own sine, as are all below."""


def twists_between(poses: RowsLast, targets: RowsLast) -> Array:
    """log6(T^-1 T_target), shape (6, N): linear m, then angular rad, in the frames of `poses`.

    With E = T^-1 T_target = (R, p): the angle t from tan t = |r| / c, r the axial vector of (R - R') / 2 and
    c = (trace R - 1) / 2, w = r t / sin t, and for the linear part
    p - w x p / 2 + b w x (w x p), b = (1 - t/2 cot(t/2)) / t^2. Angles close to a half turn one by one by
    Pinocchio.
    """
    rotation, position = poses
    axial, cosine = _axial(rotation, targets[0])
    sine = np.sqrt(np.einsum("an,an->n", axial, axial))
    angle = np.arctan2(sine, cosine)
    # One where both are nothing.
    growth = np.maximum(angle, _LEAST) / np.maximum(sine, _LEAST)
    found = np.empty((6, len(angle)))
    p, w = found[:3], np.multiply(axial, growth, out=found[3:])
    np.einsum("kan,kn->an", rotation, targets[1] - position, out=p)
    turned = _cross(w, p)
    p += _factor(angle) * _cross(w, turned) - 0.5 * turned
    wide = np.flatnonzero(cosine < _WIDE) if cosine.min(initial=1.0) < _WIDE else ()
    for row in wide:
        pose, target = (pin.SE3(turn[:, :, row], at[:, row]) for turn, at in (poses, targets))
        found[:, row] = pin.log6(pose.actInv(target)).vector
    return found


def angles_between(rotations: Array, others: Array) -> Array:
    """Angles (N,) rad by which rotations (N, 3, 3) differ from as many others, exact where they hardly do."""
    one, other = (np.ascontiguousarray(of.transpose(1, 2, 0)) for of in (rotations, others))
    axial, cosine = _axial(one, other)
    return np.asarray(np.arctan2(np.sqrt(np.einsum("an,an->n", axial, axial)), cosine))


def _axial(rotation: Array, target: Array) -> tuple[Array, Array]:
    """r (3, N) and c (N,) of R = rotation' target, by its rows x, y: sums of y x x and y . x, halved."""
    axial = _cross(target.swapaxes(0, 1), rotation.swapaxes(0, 1)).sum(axis=1)
    axial *= 0.5
    return axial, 0.5 * np.einsum("kan,kan->n", rotation, target) - 0.5


def _cross(a: Array, b: Array) -> Array:
    """Cross products of vectors (3, .., N)."""
    # Each begun once more behind its end: three calls for few rows, where calls are what costs.
    a, b = np.concatenate([a, a[:2]]), np.concatenate([b, b[:2]])
    found = a[1:4] * b[2:5]
    found -= a[2:5] * b[1:4]
    return np.asarray(found)


def _factor(angle: Array) -> Array:
    """b (N,) = (1 - t/2 cot(t/2)) / t^2."""
    t2 = angle * angle
    if angle.max(initial=0.0) < _FEW_TERMS_BELOW:
        return 1 / 12 + t2 * (1 / 720 + t2 / 30240)
    small = angle < _SERIES_BELOW
    tail = 1 / 1209600 + t2 * (1 / 47900160 + t2 * 691 / 1307674368000)
    series = 1 / 12 + t2 * (1 / 720 + t2 * (1 / 30240 + t2 * tail))
    half = 0.5 * np.where(small, 1.0, angle)
    return np.where(small, series, (1.0 - half / np.tan(half)) / (4.0 * half * half))
