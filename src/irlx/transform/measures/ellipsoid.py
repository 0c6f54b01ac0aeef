"""The volume of the ellipsoid that a matrix makes of the unit ball, and how it changes with the matrix."""

from __future__ import annotations

import numpy as np

from irlx.transform.measures.measure import Array

SINGULAR = 1e-12
"""Ratio of the smallest to the largest singular value up to which a matrix counts as singular."""


def volume(matrix: Array) -> float:
    """Product of the min(m, n) singular values of a matrix (m, n); 0 where it is singular.

    For m <= n this is sqrt(det(A A')), for m > n sqrt(det(A' A)).
    """
    singular = np.linalg.svd(matrix, compute_uv=False)
    return float(np.prod(singular)) if singular[-1] > SINGULAR * singular[0] else 0.0


def volume_derivative(matrix: Array) -> Array:
    """Derivative G of `volume` by the entries of a matrix, same shape: d volume = sum of G * dA.

    G = U diag(product of the other singular values) V', which is volume * tr((A A')^-1 A dA') without the
    square of the condition number. At a singular matrix the volume has a kink, in all directions alike:
    volume(A + dA) and volume(A - dA) agree to first order. G is 0 there, the middle of all the derivatives
    nearby (Clarke) and the limit of the central difference.
    """
    left, singular, right = np.linalg.svd(matrix, full_matrices=False)
    if singular[-1] <= SINGULAR * singular[0]:
        return np.zeros_like(matrix)
    return np.asarray(left * (np.prod(singular) / singular) @ right)
