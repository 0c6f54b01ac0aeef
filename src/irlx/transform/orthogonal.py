"""The compact step where J is nearly singular: orthogonal factors instead of a Gram matrix, then refined.

In x = L'd, H = L L', the problem without bounds is  min |x + L^-1 g|  subject to  A x = e,  A = J L^-T.
With A' = Q1 R, and Q2 orthogonal to it,  x = Q1 R^-T e - Q2 Q2' L^-1 g,  and L^-T Q2 spans the null space of
J, orthonormal under H. That is backward stable: the error is eps cond(A); with J H^-1 J' it is eps cond(A)^2.
Refined with residuals that do not round (Bjorck, Iterative refinement of linear least squares solutions I,
BIT 7, 1967) both are good to their last digits, for as long as eps cond(A) is well below one.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import fsum

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular

from irlx.transform.metric import as_matrix, root, rows_over_root, solved_by_root

Array = NDArray[np.float64]

FLAT = 1e-4
"""Sine of the angle of a row of J to the rows before it from which on the factors of J itself are needed."""

_LOST = 1e-14
_ROUNDS = 6
_TURNS = 2
_SPLIT = 134217729.0


@dataclass(frozen=True)
class Factors:
    """A' = Q1 R of A = J L^-T: `along` Q1 (n, m), `aside` Q2 (n, n - m), `triangle` R (m, m), `root` of H.

    `sine`: least sine of the angle between a row of A and those before it, whatever their units.
    """

    along: Array
    aside: Array
    triangle: Array
    root: Array
    sine: float

    @classmethod
    def of(cls, jacobian: Array, hessian: Array) -> Factors:
        """Factors for J (m, n), m <= n, and H."""
        m = len(jacobian)
        half = root(hessian)
        columns = rows_over_root(jacobian, half).T
        orthonormal, triangle = np.linalg.qr(columns, mode="complete")
        lengths = np.sqrt(np.einsum("ij,ij->j", columns, columns))
        sine = float(np.min(np.abs(np.diagonal(triangle)) / np.maximum(lengths, 1e-300), initial=1.0))
        return cls(orthonormal[:, :m], orthonormal[:, m:], triangle[:m], half, sine)

    @property
    def lost(self) -> bool:
        """Whether J has lost its rank to rounding, or its entries are no numbers."""
        return not self.sine > _LOST

    def shortest(self, e: Array) -> Array:
        """L^-T Q1 R^-T e: the H-shortest d (n, ...) with J d = e (m, ...)."""
        return solved_by_root(self.root, self.along @ solve_triangular(self.triangle, e, trans=1))


def refined_step(jacobian: Array, twist: Array, gradient: Array, hessian: Array) -> Array:
    """d (n,) of  H d - J'k = -g,  J d = e.  Raises numpy.linalg.LinAlgError where J has lost its rank."""
    m, n = jacobian.shape
    factors = Factors.of(jacobian, hessian) if m <= n else None
    if factors is None or factors.lost:
        raise np.linalg.LinAlgError("the Jacobian has lost its rank")
    matrix = np.block([[as_matrix(hessian), -jacobian.T], [jacobian, np.zeros((m, m))]])
    right = np.concatenate([-gradient, twist])
    solution, before = np.zeros(n + m), np.inf
    for _ in range(_ROUNDS):
        correction = _optimum(factors, unrounded_residual(matrix, solution, right))
        size = float(np.max(np.abs(correction[:n]), initial=0.0))
        if not size < 0.5 * before:
            # What is left is rounding.
            break
        solution, before = solution + correction, size
    return solution[:n]


def _optimum(factors: Factors, right: Array) -> Array:
    """d and k, (n + m,), of  H d - J'k = f,  J d = e  for `right` f and e, (n + m,)."""
    n = factors.along.shape[0]
    pull = solved_by_root(factors.root, right[:n], transposed=False)
    met = solve_triangular(factors.triangle, right[n:], trans=1)
    x = factors.along @ met + factors.aside @ (factors.aside.T @ pull)
    k = solve_triangular(factors.triangle, met - factors.along.T @ pull)
    return np.concatenate([solved_by_root(factors.root, x), k])


def null_space(jacobian: Array, hessian: Array) -> Array:
    """N = L^-T Q2 of shape (n, n - m): J N = 0, N'HN = 1.

    Near a singular posture rounding turns Q2 by eps / sine; J N itself says by how much. Where J has lost
    its rank these are n - m directions of a larger null space.
    """
    factors = Factors.of(jacobian, hessian)
    rows = solved_by_root(factors.root, factors.aside)
    if factors.lost or factors.sine > FLAT:
        return rows
    none = np.zeros(len(jacobian))
    for _ in range(_TURNS):
        off = np.array([unrounded_residual(jacobian, column, none) for column in rows.T]).T
        rows = rows + factors.shortest(off)
    return rows


def unrounded_residual(matrix: Array, x: Array, right: Array) -> Array:
    """b - M x of shape (m,), rounded once: products as sums of two floats (Dekker's), added exactly."""
    products = matrix * x
    matrix_high, x_high = _high(matrix), _high(x)
    matrix_low, x_low = matrix - matrix_high, x - x_high
    rest = (
        (matrix_high * x_high - products) + matrix_high * x_low + matrix_low * x_high
    ) + matrix_low * x_low
    terms = np.hstack([right[:, None], -products, -rest])
    return np.array([fsum(row) for row in terms.tolist()])


def _high(values: Array) -> Array:
    """The upper 26 bits of floats; products of such parts are exact."""
    spread = _SPLIT * values
    return np.asarray(spread - (spread - values))
