"""What to do where a Newton step has no solution: singular postures, poses out of reach."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics, Sizes
from irlx.transform.compact import StepProblem
from irlx.transform.least_squares import least_squares_in_bounds
from irlx.transform.metric import rows_over

Array = NDArray[np.float64]

_DAMPING = 1e-3
_NO_ROOM = 1e-12


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
    scale = kinematics.row_scale
    movable = free & (upper - lower > _NO_ROOM)
    full: Array = np.where(free, np.clip(q, lower, upper), q)

    def residual(x: Array) -> tuple[Array, Array]:
        full[movable] = x
        left, derivative = kinematics.difference_derivative(full, target)
        return scale * left, scale[:, None] * derivative[:, movable]

    if np.any(movable):
        low, high = lower[movable], upper[movable]
        full[movable] = least_squares_in_bounds(residual, full[movable], low, high)
    left = kinematics.difference(full, target)[0]
    return Nearest(full, left, kinematics.sizes(left))
