"""One Newton step: the criterion's minimum along the path, in the null space of the task.

The quadratic problem  min g' d + 1/2 d' H d,  J d = e,  lower <= d <= upper  loses its equality
constraints by d = d_p + N y: d_p meets them, N spans the null space of J. With d_p the minimiser
without bounds, the rest is a least-norm problem in the few unknowns y (n - m of them).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dposv, dpotrs

from irlx.transform.clearance import SideRows
from irlx.transform.metric import rows_over, solved
from irlx.transform.orthogonal import FLAT, null_space, refined_step
from irlx.transform.precision import QP_EXCESS
from irlx.transform.qp.interval import IntervalSolver
from irlx.transform.qp.solver import QpSolver

Array = NDArray[np.float64]

_CORRECTED = 1e-6
"""Part of a step that its correction may be; its square is what the correction leaves of it."""

# Libraries of linear algebra take their working memory with the first matrix that they factor, and where none
# is left by then they try for ever. Here, where they are loaded, nothing else has it yet, and the command
# line has seen to it that there is enough.
dposv(np.eye(1), np.ones(1))
np.linalg.solve(np.eye(1), np.ones(1))


@dataclass(frozen=True)
class StepProblem:
    """One Newton step written out, so that it can be inspected apart from being solved.

    `jacobian` J (m, n); `twist` e (m,) what is left to the demanded pose; `gradient` g (n,) and
    `hessian` H of the criterion, its diagonal (n,) or all of it (n, n); `lower`, `upper` (n,) bounds of d;
    `sides` further inequalities.
    """

    jacobian: Array
    twist: Array
    gradient: Array
    hessian: Array
    lower: Array
    upper: Array
    sides: SideRows | None = None

    def keeps(self, d: Array) -> bool:
        """Whether a step (n,) keeps bounds and inequalities."""
        return within(d, self.lower, self.upper) and (self.sides is None or self.sides.hold(d))


@dataclass(frozen=True)
class Step:
    """Solution d (n,), and per joint +1 / -1 where it is held at its upper / lower bound."""

    d: Array
    active: NDArray[np.int8]


def free_step(problem: StepProblem) -> Array:
    """Minimiser without bounds: d = H^-1 (J' k - g) with J H^-1 J' k = e + J H^-1 g.

    The Gram matrix squares the condition of J. A correction of what is left of the pose takes that back for
    as long as there is something of the first solution left; beyond that J is factored itself.
    Raises numpy.linalg.LinAlgError where J has lost its rank.
    """
    scaled = rows_over(problem.jacobian, problem.hessian)
    gram = scaled @ problem.jacobian.T
    factor, k, failed = dposv(gram, problem.twist + scaled @ problem.gradient)
    if not failed and not nearly_singular(gram, factor):
        pull = solved(problem.hessian, problem.gradient)
        d = scaled.T @ k - pull
        correction = scaled.T @ dpotrs(factor, problem.twist - problem.jacobian @ d)[0]
        if correction.dot(correction) <= _CORRECTED**2 * max(d.dot(d), pull.dot(pull)):
            return np.asarray(d + correction)
    return refined_step(problem.jacobian, problem.twist, problem.gradient, problem.hessian)


def path_step(problem: StepProblem) -> Array:
    """Shortest step that meets the pose: d = H^-1 J' (J H^-1 J')^-1 e, length measured by H.

    Raises numpy.linalg.LinAlgError where J has lost its rank.
    """
    scaled = rows_over(problem.jacobian, problem.hessian)
    gram = scaled @ problem.jacobian.T
    factor, k, failed = dposv(gram, problem.twist)
    if failed or nearly_singular(gram, factor):
        nothing = np.zeros(problem.gradient.size)
        return refined_step(problem.jacobian, problem.twist, nothing, problem.hessian)
    return np.asarray(scaled.T @ k)


def nearly_singular(gram: Array, factor: Array) -> bool:
    """Whether a row of J is nearly a combination of those before it, by Cholesky's factor C of G = J H^-1 J'.

    c_ii^2 / g_ii is the square of the sine of the angle between them, whatever the units of the rows.
    """
    left = factor.diagonal().tolist()
    return any(c * c <= FLAT**2 * g for c, g in zip(left, gram.diagonal().tolist(), strict=True))


def within(d: Array, lower: Array, upper: Array) -> bool:
    """Whether every component lies in its bounds."""
    return bool(np.all((d >= lower) & (d <= upper)))


def bounded_step(problem: StepProblem, d_free: Array, solver: QpSolver) -> Step | None:
    """Minimiser with bounds, given the one without; None where no step keeps path and bounds.

    In d = d_p + N z, N'HN = 1, the problem is min 1/2 |z|^2, lower - d_p <= N z <= upper - d_p, and the same
    for the rows of `sides`.
    Raises ArithmeticError where the solver's answer breaks the bounds: clipping it into them would hide
    that the step no longer keeps the path.
    """
    lower, upper = problem.lower - d_free, problem.upper - d_free
    rows = null_space_rows(problem)
    if rows.shape[1] == 0:
        return None
    joints = d_free.size
    if problem.sides is not None:
        rows = np.vstack([rows, problem.sides.matrix @ rows])
        lower = np.concatenate([lower, problem.sides.lower - problem.sides.matrix @ d_free])
        upper = np.concatenate([upper, np.full(len(problem.sides.lower), np.inf)])
    one_unknown = rows.shape[1] == 1
    solution = (IntervalSolver() if one_unknown else solver).solve(rows, lower, upper)
    if solution.z is None:
        return None
    moved = rows @ solution.z
    excess = float(np.max(np.maximum(moved - upper, lower - moved)))
    if not excess <= QP_EXCESS * max(1.0, float(np.max(np.abs(rows))), float(np.max(np.abs(moved)))):
        raise ArithmeticError(f"a QP step lies {excess:.3g} outside its bounds: its solver is at fault")
    d, active = d_free + moved[:joints], solution.active[:joints]
    # Joints held at a bound stand on it to the last bit, whatever the products above rounded to.
    d = np.where(active > 0, problem.upper, np.where(active < 0, problem.lower, d))
    return Step(d, active)


def null_space_rows(problem: StepProblem) -> Array:
    """N of shape (n, n - m), N'HN = 1: an H-orthonormal basis of the null space of J."""
    m, n = problem.jacobian.shape
    return null_space(problem.jacobian, problem.hessian) if m < n else np.zeros((n, 0))
