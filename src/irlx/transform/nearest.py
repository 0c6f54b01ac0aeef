"""Steps for the two cases in which the exact problem has none: singular postures, closed bounds."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.transform.compact import StepProblem

Array = NDArray[np.float64]

_DAMPING = 1e-3
_SHARE_OF_CRITERION = 1e-6


def scaled_singular_values(jacobian: Array, reach: float) -> Array:
    """Singular values of a tool Jacobian (6, n), position rows divided by the robot's reach (m)."""
    scaled = jacobian.copy()
    scaled[:3] /= reach
    return np.asarray(np.linalg.svd(scaled, compute_uv=False))


def damped_step(problem: StepProblem, reach: float) -> Array:
    """Step of a posture near a singular one: d = H^-1 J' (J H^-1 J' + c I)^-1 e, rows scaled by reach.

    It shapes an iterate only; what it leaves of the pose is judged like any other residual.
    """
    row_scale = np.array([1.0 / reach] * 3 + [1.0] * 3)
    rows = problem.jacobian * row_scale[:, None]
    scaled = rows / problem.hessian
    gram = scaled @ rows.T
    damping = _DAMPING**2 * float(np.trace(gram))
    k = np.linalg.solve(gram + damping * np.eye(6), problem.twist * row_scale)
    return np.asarray(scaled.T @ k)


def nearest_step(problem: StepProblem, reach: float) -> Array:
    """Step within the bounds that comes nearest to the demanded pose (least squares).

    Used where no step keeps path and bounds: its residual says by how much the robot falls short.
    """
    from scipy.optimize import lsq_linear

    row_scale = np.array([1.0 / reach] * 3 + [1.0] * 3)
    root = np.sqrt(_SHARE_OF_CRITERION * problem.hessian / np.max(problem.hessian))
    matrix = np.vstack([problem.jacobian * row_scale[:, None], np.diag(root)])
    target = np.concatenate([problem.twist * row_scale, np.zeros(root.size)])
    lower, upper = np.minimum(problem.lower, problem.upper), np.maximum(problem.lower, problem.upper)
    moving = upper > lower
    d = np.where(moving, 0.0, lower)
    if np.any(moving):
        rest = target - matrix @ d
        solution = lsq_linear(matrix[:, moving], rest, (lower[moving], upper[moving]), method="bvls")
        d[moving] = solution.x
    return d
