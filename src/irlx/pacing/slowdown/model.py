"""What every stage of a planned motion needs to know of the robot."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from irlx.motion.pose_path import Poses
from irlx.pacing.slowdown.reserve import RESERVE
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.robot.pose_targets import PoseTargets
from irlx.transform.clearance import Clearance
from irlx.transform.row_rank import independent_rows, usual_rank

Array = NDArray[np.float64]


_NO_WAY = 1e-10
_BRAKE_SHARE = 0.9


@dataclass(frozen=True)
class Model:
    """Kinematics, limits in force, weights (n,), joints that are not frozen (n,), what is kept clear."""

    kinematics: Kinematics
    limits: JointLimits
    weights: Array
    free: NDArray[np.bool_]
    clearance: Clearance | None = None

    @property
    def freedom(self) -> int:
        """Joints more than the pose needs: dimension r of the null space."""
        return int(np.count_nonzero(self.free)) - self.kinematics.rows

    @property
    def movable(self) -> NDArray[np.bool_]:
        """Free joints (n,) that no limit holds in place: who may not speed up or not slow down cannot go."""
        limits = self.limits
        held = (limits.speed_lower == 0.0) & (limits.speed_upper == 0.0)
        held |= (limits.acceleration_lower == 0.0) | (limits.acceleration_upper == 0.0)
        held |= limits.position_lower == limits.position_upper
        return np.asarray(self.free & ~held)

    @property
    def narrow(self) -> NDArray[np.bool_]:
        """Joints (n,) with so narrow a range that it leaves no room for the reserve of a plan."""
        width = self.limits.position_upper - self.limits.position_lower
        return np.asarray(0.25 * width < RESERVE)

    @property
    def limitless(self) -> NDArray[np.bool_]:
        """Joints (n,) whose speed and acceleration nothing limits."""
        sides = [side for kind in ("speed", "acceleration") for side in self.limits.pair(kind)]
        return np.asarray(np.all(np.isinf(sides), axis=0))

    @cached_property
    def speeds_either_way(self) -> Array:
        """Largest speeds (2 n,) of the joints, upwards and then downwards, rad/s or m/s."""
        return np.concatenate([self.limits.speed_upper, -self.limits.speed_lower])

    @cached_property
    def brakes(self) -> Array:
        """Decelerations (2 n,) that a step may count on when it moves upwards and when downwards."""
        limits = self.limits
        return _BRAKE_SHARE * np.concatenate([-limits.acceleration_lower, limits.acceleration_upper])

    def targets(self, poses: Poses) -> PoseTargets:
        """Poses as the kinematics keeps them; made once for all uses of a grid."""
        return PoseTargets(poses.rotation, poses.position)

    def differences(self, q: Array, targets: PoseTargets) -> tuple[Array, Array]:
        """What is left (N, m) from postures q (N, n) to the targets, matrices (N, m, f) of free joints."""
        twists, jacobians = self.kinematics.differences(q, targets)
        return twists, jacobians[:, :, self.free]

    def onto_path(
        self,
        q: Array,
        targets: PoseTargets,
        rounds: int,
        held: NDArray[np.bool_] | None = None,
    ) -> OntoPath:
        """Postures after `rounds` W-least Newton steps towards the targets.

        Where the free joints cannot move all of a pose, whatever their posture, they do what they can of it.
        Frozen joints keep their bits, so do those of single rows in `held` (N, n). Raises
        numpy.linalg.LinAlgError where a Jacobian has lost its rank.
        """
        inverse = np.ones((1, 1, 1)) / self.weights[self.free]
        if held is not None:
            inverse = np.where(held[:, None, self.free], 0.0, inverse)
        moved = q.copy()
        m, free = self.kinematics.rows, int(np.sum(self.free))
        twists, jacobians = np.zeros((len(q), m)), np.zeros((len(q), m, free))
        rank = usual_rank(self.kinematics, q[0], self.free)
        for _ in range(rounds):
            twists, jacobians = self.differences(moved, targets)
            asked, rows = twists[:, :, None], jacobians
            if self.freedom >= 0 and rank < m:
                chosen = independent_rows(jacobians, self.kinematics.row_scale, rank)
                asked, rows = chosen @ asked, chosen @ rows
            scaled = rows * inverse
            gram = scaled @ np.swapaxes(rows, 1, 2)
            if self.freedom >= 0:
                k = np.linalg.solve(gram, asked)
            else:
                # Fewer joints than the pose has coordinates: what they can do of it.
                k = np.linalg.pinv(gram, rcond=_NO_WAY, hermitian=True) @ asked
            moved[:, self.free] += (np.swapaxes(scaled, 1, 2) @ k)[:, :, 0]
        return OntoPath(moved, twists, jacobians)


class OntoPath(NamedTuple):
    """Postures q (N, n) brought onto poses; twists (N, m) and Jacobians (N, m, f) before the last step.

    That step squares the twists.
    """

    q: Array
    twists: Array
    jacobians: Array


def null_spaces(jacobians: Array) -> Array:
    """Orthonormal bases (N, f, r) of the null spaces of Jacobians (N, m, f)."""
    orthonormal = np.linalg.qr(np.swapaxes(jacobians, 1, 2), mode="complete")[0]
    return np.asarray(orthonormal[:, :, jacobians.shape[1] :])
