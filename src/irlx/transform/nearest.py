"""What to do where a Newton step has no solution: singular postures, poses out of reach."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics, Sizes
from irlx.transform.compact import StepProblem
from irlx.transform.least_squares import least_squares_from, least_squares_in_bounds
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

    Frozen joints stay. Least squares of what is left, displacements divided by the robot's lever. Used where
    Newton steps find nothing: its residual says how far the robot falls short.
    """
    left = _Left(
        kinematics, target, np.where(free, np.clip(q, lower, upper), q), _movable(lower, upper, free)
    )
    if left.movable.any():
        low, high = lower[left.movable], upper[left.movable]
        left.moved(least_squares_in_bounds(left, left.q[left.movable], low, high))
    return left.nearest


def nearest_from(
    kinematics: Kinematics,
    target: pin.SE3,
    starts: Sequence[Array],
    lower: Array,
    upper: Array,
    free: NDArray[np.bool_],
) -> Iterator[tuple[int, Nearest]]:
    """What `nearest_in_bounds` gives from each of some starts (n,), with its number, once it is found."""
    movable = _movable(lower, upper, free)
    begun = [np.where(free, np.clip(q, lower, upper), q) for q in starts]
    lefts = [_Left(kinematics, target, q, movable) for q in begun]
    if not movable.any():
        yield from ((k, left.nearest) for k, left in enumerate(lefts))
        return
    low, high = lower[movable], upper[movable]
    for k, x in least_squares_from(lefts, [left.q[movable] for left in lefts], low, high):
        lefts[k].moved(x)
        yield k, lefts[k].nearest


def _movable(lower: Array, upper: Array, free: NDArray[np.bool_]) -> NDArray[np.bool_]:
    return free & (upper - lower > _NO_ROOM)


class _Left:
    """What is left of a pose, rows scaled to one unit, as a residual of the `movable` joints (n,)."""

    def __init__(self, kinematics: Kinematics, target: pin.SE3, q: Array, movable: NDArray[np.bool_]) -> None:
        self._kinematics, self._target, self.movable = kinematics, target, movable
        self.q = q

    def moved(self, x: Array) -> None:
        """Put the movable joints there."""
        self.q[self.movable] = x

    def __call__(self, x: Array) -> tuple[Array, Array]:
        self.moved(x)
        left, derivative = self._kinematics.difference_derivative(self.q, self._target)
        scale = self._kinematics.row_scale
        return scale * left, scale[:, None] * derivative[:, self.movable]

    @property
    def nearest(self) -> Nearest:
        """Where the joints are now, and what is left there."""
        left = self._kinematics.difference(self.q, self._target)[0]
        return Nearest(self.q, left, self._kinematics.sizes(left))
