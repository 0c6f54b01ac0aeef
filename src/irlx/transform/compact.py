"""One Newton step: the criterion's minimum along the path, in the null space of the task.

The quadratic problem  min g' d + 1/2 d' H d,  J d = e,  lower <= d <= upper  loses its equality
constraints by d = d_p + N y: d_p meets them, N spans the null space of J. With d_p the minimiser
without bounds, the rest is a least-norm problem in the few unknowns y (n - m of them).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dposv

from irlx.transform.metric import rows_over, solved, within_basis
from irlx.transform.precision import QP_EXCESS
from irlx.transform.qp.interval import IntervalSolver
from irlx.transform.qp.solver import QpSolver

Array = NDArray[np.float64]


@dataclass(frozen=True)
class StepProblem:
    """One Newton step written out, so that it can be inspected apart from being solved.

    `jacobian` J (m, n); `twist` e (m,) what is left to the demanded pose; `gradient` g (n,) and
    `hessian` H of the criterion, its diagonal (n,) or all of it (n, n); `lower`, `upper` (n,) bounds of d.
    """

    jacobian: Array
    twist: Array
    gradient: Array
    hessian: Array
    lower: Array
    upper: Array


@dataclass(frozen=True)
class Step:
    """Solution d (n,), and per joint +1 / -1 where it is held at its upper / lower bound."""

    d: Array
    active: NDArray[np.int8]


def solve_gram(gram: Array, right: Array) -> Array:
    """k (m,) of G k = right, G = J H^-1 J' of shape (m, m), by Cholesky factors.

    Where they do not exist to rounding, LU factors are tried; raises numpy.linalg.LinAlgError where
    these say that J has lost its rank.
    """
    _, k, failed = dposv(gram, right)
    return np.asarray(np.linalg.solve(gram, right) if failed else k)


def free_step(problem: StepProblem) -> Array:
    """Minimiser without bounds: d = H^-1 (J' k - g) with J H^-1 J' k = e + J H^-1 g.

    Raises numpy.linalg.LinAlgError where J has lost its rank.
    """
    scaled = rows_over(problem.jacobian, problem.hessian)
    gram = scaled @ problem.jacobian.T
    k = solve_gram(gram, problem.twist + scaled @ problem.gradient)
    d = scaled.T @ k - solved(problem.hessian, problem.gradient)
    # The Gram matrix squares the condition of J; correcting what is left of the pose takes one half back.
    return np.asarray(d + scaled.T @ solve_gram(gram, problem.twist - problem.jacobian @ d))


def path_step(problem: StepProblem) -> Array:
    """Shortest step that meets the pose: d = H^-1 J' (J H^-1 J')^-1 e, length measured by H.

    Raises numpy.linalg.LinAlgError where J has lost its rank.
    """
    scaled = rows_over(problem.jacobian, problem.hessian)
    return np.asarray(scaled.T @ solve_gram(scaled @ problem.jacobian.T, problem.twist))


def within(d: Array, lower: Array, upper: Array) -> bool:
    """Whether every component lies in its bounds."""
    return bool(np.all((d >= lower) & (d <= upper)))


def bounded_step(problem: StepProblem, d_free: Array, solver: QpSolver) -> Step | None:
    """Minimiser with bounds, given the one without; None where no step keeps path and bounds.

    In y = L^-T z, L L' = N' H N, the problem is min 1/2 |z|^2, lower - d_p <= N L^-T z <= upper - d_p.
    Raises ArithmeticError where the solver's answer breaks the bounds: clipping it into them would hide
    that the step no longer keeps the path.
    """
    lower, upper = problem.lower - d_free, problem.upper - d_free
    rows = null_space_rows(problem)
    if rows.shape[1] == 0:
        return None
    one_unknown = rows.shape[1] == 1
    solution = (IntervalSolver() if one_unknown else solver).solve(rows, lower, upper)
    if solution.z is None:
        return None
    moved = rows @ solution.z
    excess = float(np.max(np.maximum(moved - upper, lower - moved)))
    if not excess <= QP_EXCESS * max(1.0, float(np.max(np.abs(rows))), float(np.max(np.abs(moved)))):
        raise ArithmeticError(f"a QP step lies {excess:.3g} outside its bounds: its solver is at fault")
    d = d_free + moved
    # Joints held at a bound stand on it to the last bit, whatever the products above rounded to.
    d = np.where(solution.active > 0, problem.upper, np.where(solution.active < 0, problem.lower, d))
    return Step(d, solution.active)


def null_space_rows(problem: StepProblem) -> Array:
    """N L^-T of shape (n, n - m): an H-orthonormal basis of the null space of J."""
    m, n = problem.jacobian.shape
    if m >= n:
        return np.zeros((n, 0))
    orthonormal, _ = np.linalg.qr(problem.jacobian.T, mode="complete")
    basis = orthonormal[:, m:]
    factor = np.linalg.cholesky(within_basis(problem.hessian, basis))
    return np.asarray(np.linalg.solve(factor, basis.T).T)
