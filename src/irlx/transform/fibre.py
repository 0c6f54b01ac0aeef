"""The fibre of a tool pose: all postures that keep it, and the slope of the distance to a posture on it.

On the fibre {q : tool pose(q) = pose} the weighted distance phi(q) = 1/2 (q - k)' W (q - k) to a posture k
has the gradient g = W (q - k). What moves along the fibre can feel of it is its part in the null space of
the tool Jacobian J, without the joints that the gradient presses against their position limits. The rows of
J count as far as they are independent at nearly all postures (row_rank.py): what joints have to spare does
not change at a singular posture.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics
from irlx.transform.compact import StepProblem, bounded_step, free_step, within
from irlx.transform.qp.dual import DualSolver
from irlx.transform.row_rank import independent_rows, usual_rank

Array = NDArray[np.float64]

ON_POSE = 1e-13
"""Pose error (m, rad) at which a correction back onto the pose is done."""

AT_LIMIT = 1e-9
"""A joint this near to its position limit (rad or m) stands on it."""

_LEFT_ON_POSE = 1e-12
_CORRECTIONS = 12
_LONGEST_CORRECTION = 0.5
_DIFFERENCE = 1e-5
_UNMOVED = 1e-9
_BACK_INSIDE = 1e-13
_TOGETHER = 3
_NEARLY = 1e-6
_SAME_RANK = 6
"""Digits of the values of joints that stand, rad or m, by which ranks are kept."""


@dataclass(frozen=True)
class Tangent:
    """The fibre near one posture, for the joints that may move along it.

    `movable` (n,): not frozen, not pressed against a limit. `basis` (n, r): columns tangent to the fibre with
    basis' W basis = 1, zero for the other joints. `gradient` (n,): W (q - k), zero for frozen joints.
    `projected`: largest component of the gradient's orthogonal projection onto the tangent space.
    """

    movable: NDArray[np.bool_]
    basis: Array
    jacobian: Array
    gradient: Array
    projected: float


class Fibre:
    """Postures of one tool pose within position limits, and the distance to the posture `konf` on them.

    `konf`, `weights`, `lower`, `upper`, `free` have shape (n,), rad or m; joints that are not `free` keep
    their values and do not count in the distance.
    """

    def __init__(
        self,
        kinematics: Kinematics,
        target: pin.SE3,
        konf: Array,
        weights: Array,
        bounds: tuple[Array, Array],
        free: NDArray[np.bool_],
        coarse: bool = False,
    ) -> None:
        """`coarse`: curvatures need not be better than a dry run needs them."""
        self.kinematics = kinematics
        self.target = target
        self.konf = konf
        self.weights = weights
        self.lower, self.upper = bounds
        self.free = free
        self._qp = DualSolver()
        self._coarse = coarse
        self._reach = max(1.0, kinematics.description.reach)
        self._ranks: dict[bytes, int] = {}

    def within(self, lower: Array, upper: Array) -> Fibre:
        """The same fibre within other position limits (n,)."""
        other = Fibre(
            self.kinematics, self.target, self.konf, self.weights, (lower, upper), self.free, self._coarse
        )
        other._ranks = self._ranks
        return other

    def rank(self, q: Array, movable: NDArray[np.bool_]) -> int:
        """Coordinates of the pose that joints `movable` (n,) can move, the others standing as in q (n,)."""
        key = movable.tobytes() + np.round(q[~movable], _SAME_RANK).tobytes()
        if key not in self._ranks:
            self._ranks[key] = usual_rank(self.kinematics, q, movable)
        return self._ranks[key]

    def leads_back(self, q: Array, movable: NDArray[np.bool_]) -> bool:
        """Whether joints `movable` (n,) may lead q back onto the pose after a step of the free ones."""
        rank, count = self.rank(q, movable), int(np.count_nonzero(movable))
        return count > rank or rank == self.rank(q, self.free)

    def _rows(self, q: Array, jacobian: Array, movable: NDArray[np.bool_]) -> Array:
        """P (rank, m): combinations of the rows of J (m, n) that say once each what the joints move."""
        return independent_rows(jacobian[:, movable], self.kinematics.row_scale, self.rank(q, movable))

    def distance(self, q: Array) -> float:
        """1/2 (q - k)' W (q - k) of the free joints."""
        away = (q - self.konf)[self.free]
        return float(0.5 * (self.weights[self.free] * away) @ away)

    def decrease(self, q: Array, new: Array) -> float:
        """distance(q) - distance(new), without the cancellation of that difference."""
        step = (new - q)[self.free]
        middle = (q - self.konf)[self.free] + 0.5 * step
        return -float((self.weights[self.free] * middle) @ step)

    def onto_pose(self, q: Array, movable: NDArray[np.bool_] | None = None) -> Array | None:
        """Posture on the pose by W-least Newton steps from q (n,), within limits; None where they fail.

        Only `movable` joints (n,) step, by default all free ones. Where the limits leave a single step no
        way, a joint may pass its own on the way and has to be back at the end: the elbow of an arm with
        spherical shoulder and wrist does so when it stands on its limit.
        """
        free = self.free if movable is None else movable
        found = np.where(self.free, np.clip(q, self.lower, self.upper), q)
        inside = self._newton(found, free, (self.lower, self.upper))
        if inside is not None:
            return inside
        nowhere = np.full(q.size, np.inf)
        outside = self._newton(found, free, (-nowhere, nowhere))
        if outside is None:
            return None
        back = np.where(free, np.clip(outside, self.lower, self.upper), outside)
        return back if float(np.max(np.abs(back - outside))) <= _BACK_INSIDE else None

    def all_onto_pose(self, q: Array) -> Array | None:
        """Postures on the pose by W-least Newton steps of the free joints from q (K, n), whatever the limits.

        Those that do not come onto it are no numbers; None where the free joints cannot move all of the pose.
        """
        kinematics, free = self.kinematics, self.free
        if self.rank(q[0], free) < kinematics.rows:
            return None
        found, inverse = q.copy(), 1.0 / self.weights[free]
        for _ in range(_TOGETHER):
            steps = [kinematics.difference(row, self.target) for row in found]
            twists, jacobians = (
                np.array([one[0] for one in steps]),
                np.array([one[1][:, free] for one in steps]),
            )
            scaled = jacobians * inverse
            try:
                k = np.linalg.solve(scaled @ np.swapaxes(jacobians, 1, 2), twists[:, :, None])
            except np.linalg.LinAlgError:
                return None
            found[:, free] += (np.swapaxes(scaled, 1, 2) @ k)[:, :, 0]
        found[~np.all(np.abs(twists) <= _NEARLY, axis=1)] = np.nan
        return np.asarray(found)

    def _newton(self, q: Array, free: NDArray[np.bool_], bounds: tuple[Array, Array]) -> Array | None:
        """Posture on the pose by steps of the joints `free` (n,) that keep `bounds`; None where they fail."""
        found, least = q, np.inf
        for _ in range(_CORRECTIONS):
            twist, jacobian = self.kinematics.difference(found, self.target)
            error = float(np.max(np.abs(twist)))
            if error <= ON_POSE or (error <= _LEFT_ON_POSE * self._reach and error >= 0.5 * least):
                return found
            least = min(least, error)
            room = (bounds[0] - found)[free], (bounds[1] - found)[free]
            rows = self._rows(found, jacobian, free)
            step = self._correction(rows @ twist, rows @ jacobian[:, free], self.weights[free], room)
            if step is None or float(np.max(np.abs(step), initial=0.0)) > _LONGEST_CORRECTION:
                return None
            moved = found.copy()
            moved[free] += step
            found = np.where(free, np.clip(moved, *bounds), found)
        return None

    def _correction(
        self, twist: Array, jacobian: Array, weights: Array, room: tuple[Array, Array]
    ) -> Array | None:
        if len(twist) == 0:
            return None
        problem = StepProblem(jacobian, twist, np.zeros(weights.size), weights, *room)
        try:
            step = free_step(problem)
            if within(step, *room):
                return step
            bounded = bounded_step(problem, step, self._qp)
        except (np.linalg.LinAlgError, ArithmeticError):
            # Bounds that leave no way back: the solver may also find an answer that keeps them not quite.
            return None
        return None if bounded is None else bounded.d

    def tangent(self, q: Array) -> Tangent:
        """What can move along the fibre at q (n,), a posture on it, and how steep the distance is there."""
        jacobian = np.array(self.kinematics.difference(q, self.target)[1])
        gradient = np.where(self.free, self.weights * (q - self.konf), 0.0)
        movable = self.free & ~self._pressed(q, jacobian, gradient)
        basis = self._basis(q, jacobian, movable)
        orthonormal, _ = np.linalg.qr(basis) if basis.shape[1] else (basis, None)
        along = orthonormal @ (orthonormal.T @ gradient)
        return Tangent(movable, basis, jacobian, gradient, float(np.max(np.abs(along), initial=0.0)))

    def _pressed(self, q: Array, jacobian: Array, gradient: Array) -> NDArray[np.bool_]:
        """Joints on a limit that the steepest descent along the fibre would lead beyond it, shape (n,)."""
        at_lower = self.free & (q - self.lower <= AT_LIMIT)
        at_upper = self.free & (self.upper - q <= AT_LIMIT)
        pressed = np.zeros(q.size, dtype=bool)
        if not np.any(at_lower | at_upper):
            return pressed
        basis = self._basis(q, jacobian, self.free)
        if basis.shape[1] == 0:
            return pressed
        descent = -basis @ (basis.T @ gradient)
        lower = np.where(at_lower, 0.0, -np.inf) - descent
        upper = np.where(at_upper, 0.0, np.inf) - descent
        # Steepest descent within the cone that the limits leave: its held joints are the pressed ones.
        pressed[self.free] = self._qp.solve(basis[self.free], lower[self.free], upper[self.free]).active != 0
        return pressed

    def _basis(self, q: Array, jacobian: Array, movable: NDArray[np.bool_]) -> Array:
        """W-orthonormal basis (n, r) of the null space of J over the movable joints."""
        count, rank = int(np.count_nonzero(movable)), self.rank(q, movable)
        full = np.zeros((movable.size, count - rank))
        if count > rank:
            # With d = W^-1/2 x the null space of J W^-1/2 is orthonormal in x.
            scale = 1.0 / np.sqrt(self.weights[movable])
            rows = self._rows(q, jacobian, movable) @ jacobian[:, movable]
            orthonormal, _ = np.linalg.qr((rows * scale).T, mode="complete")
            full[movable] = scale[:, None] * orthonormal[:, rank:]
            # What no motion along the fibre moves, as the elbow of an arm with spherical shoulder and wrist,
            # must not move by rounding: standing on its limit it would hold all the others.
            longest = np.max(np.abs(full), axis=1, keepdims=True)
            full = np.where(longest > _UNMOVED * float(np.max(longest)), full, 0.0)
        return full

    def curvature(self, q: Array, tangent: Tangent) -> Array:
        """Second derivative of the distance along the fibre in the basis of `tangent`, shape (r, r).

        B' (W + sum_i k_i d2c_i) B, c the pose error and k the multipliers with J'k = -g but for the part
        along the fibre; the second derivatives by central differences of the exact first ones, by one-sided
        ones where the fibre is `coarse`.
        """
        basis, movable = tangent.basis, tangent.movable
        scale = 1.0 / np.sqrt(self.weights[movable])
        rows = self._rows(q, tangent.jacobian, movable)
        columns = (rows @ tangent.jacobian[:, movable] * scale).T
        pull = -scale * tangent.gradient[movable]
        multipliers = rows.T @ np.linalg.lstsq(columns, pull, rcond=None)[0]
        bent = np.zeros_like(basis)
        for column in range(basis.shape[1]):
            step = _DIFFERENCE / max(float(np.max(np.abs(basis[:, column]))), 1e-300)
            way = step * basis[:, column]
            ahead = self.kinematics.difference_derivative(q + way, self.target)[1]
            if self._coarse:
                # On the pose the derivative is that of the twist.
                bent[:, column] = -(tangent.jacobian + ahead).T @ multipliers / step
                continue
            behind = self.kinematics.difference_derivative(q - way, self.target)[1]
            bent[:, column] = (behind - ahead).T @ multipliers / (2.0 * step)
        curved = basis.T @ bent
        return np.asarray(np.eye(basis.shape[1]) + 0.5 * (curved + curved.T))
