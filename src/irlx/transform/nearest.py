"""What to do where a Newton step has no solution: singular postures, poses out of reach."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics, Sizes
from irlx.transform.compact import StepProblem
from irlx.transform.metric import rows_over

Array = NDArray[np.float64]

_DAMPING = 1e-3
_NO_ROOM = 1e-12
_FINE = 1e-15
_EVALUATIONS = 100


def scaled_singular_values(jacobian: Array, row_scale: Array) -> Array:
    """Singular values of a task's matrix (m, n), its rows times `Kinematics.row_scale` (m,): one unit."""
    return np.asarray(np.linalg.svd(jacobian * row_scale[:, None], compute_uv=False))


def damped_step(problem: StepProblem, row_scale: Array) -> Array:
    """Step of a posture near a singular one: d = H^-1 J' (J H^-1 J' + c I)^-1 e, rows scaled to one unit.

    It shapes an iterate only; what it leaves of the pose is judged like any other residual.
    """
    rows = problem.jacobian * row_scale[:, None]
    scaled = rows_over(rows, problem.hessian)
    gram = scaled @ rows.T
    # Without any joint that moves the Gram matrix is zero, and so is the step.
    damping = _DAMPING**2 * float(np.trace(gram)) or 1.0
    k = np.linalg.solve(gram + damping * np.eye(len(row_scale)), problem.twist * row_scale)
    return np.asarray(scaled.T @ k)


@dataclass(frozen=True)
class Nearest:
    """Posture q (n,) that comes nearest to a demand, and what is left (m,) of its rows."""

    q: Array
    twist: Array
    sizes: Sizes

    @property
    def distance(self) -> float:
        """Distance left, m."""
        return self.sizes.distance

    @property
    def angle(self) -> float:
        """Angle left, rad."""
        return self.sizes.angle


def nearest_in_bounds(
    kinematics: Kinematics, target: pin.SE3, q: Array, lower: Array, upper: Array, free: NDArray[np.bool_]
) -> Nearest:
    """Posture with lower <= q <= upper (n,) that comes nearest to a pose, searched from q.

    Frozen joints stay. Least squares of what is left, displacements divided by the robot's reach. Used where
    Newton steps find nothing: its residual says how far the robot falls short.
    """
    from scipy.optimize import least_squares

    scale = kinematics.row_scale
    movable = free & (upper - lower > _NO_ROOM)

    def posture(x: Array) -> Array:
        full: Array = np.clip(q, lower, upper)
        full[~free] = q[~free]
        full[movable] = x
        return full

    def residual(x: Array) -> Array:
        return np.asarray(scale * kinematics.difference(posture(x), target)[0])

    def derivative(x: Array) -> Array:
        _, jacobian = kinematics.difference_derivative(posture(x), target)
        return np.asarray(scale[:, None] * jacobian[:, movable])

    def found_at(q: Array) -> Nearest:
        left = kinematics.difference(q, target)[0]
        return Nearest(q, left, kinematics.sizes(left))

    if not np.any(movable):
        return found_at(q)
    low, high = lower[movable], upper[movable]
    start = np.clip(q[movable], low, high)
    found = least_squares(
        residual,
        start,
        derivative,
        bounds=(low, high),
        xtol=_FINE,
        ftol=_FINE,
        gtol=_FINE,
        max_nfev=_EVALUATIONS,
    )
    return found_at(posture(found.x))
