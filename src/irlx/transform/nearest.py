"""What to do where a Newton step has no solution: singular postures, poses out of reach."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics
from irlx.transform.compact import StepProblem
from irlx.transform.metric import rows_over

Array = NDArray[np.float64]

_DAMPING = 1e-3
_NO_ROOM = 1e-12
_FINE = 1e-15
_EVALUATIONS = 100


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
    scaled = rows_over(rows, problem.hessian)
    gram = scaled @ rows.T
    # Without any joint that moves the Gram matrix is zero, and so is the step.
    damping = _DAMPING**2 * float(np.trace(gram)) or 1.0
    k = np.linalg.solve(gram + damping * np.eye(6), problem.twist * row_scale)
    return np.asarray(scaled.T @ k)


@dataclass(frozen=True)
class Nearest:
    """Posture q (n,) that comes nearest to a pose, and the twist (6,) that is left."""

    q: Array
    twist: Array

    @property
    def distance(self) -> float:
        """Distance left, m."""
        return float(np.linalg.norm(self.twist[:3]))

    @property
    def angle(self) -> float:
        """Angle left, rad."""
        return float(np.linalg.norm(self.twist[3:]))


def nearest_in_bounds(
    kinematics: Kinematics, target: pin.SE3, q: Array, lower: Array, upper: Array, free: NDArray[np.bool_]
) -> Nearest:
    """Posture with lower <= q <= upper (n,) that comes nearest to a pose, searched from q.

    Frozen joints stay. Least squares of log6 of the pose difference, its translation divided by the
    robot's reach. Used where Newton steps find nothing: its residual says how far the robot falls short.
    """
    from scipy.optimize import least_squares

    scale = np.array([1.0 / kinematics.description.reach] * 3 + [1.0] * 3)
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

    if not np.any(movable):
        return Nearest(q, kinematics.difference(q, target)[0])
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
    nearest = posture(found.x)
    return Nearest(nearest, kinematics.difference(nearest, target)[0])
