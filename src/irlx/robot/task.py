"""Which coordinates of the tool pose a robot is asked for, and how they differ between two poses."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from irlx.robot.description import COORDINATES
from irlx.robot.twists import angles_between

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Task:
    """The coordinates that count, a part of `COORDINATES` in their order; all six for most robots.

    Nobody asks for coordinates that are left out: those in which a planar arm does not move its tool.
    """

    coordinates: tuple[str, ...] = COORDINATES

    @property
    def size(self) -> int:
        """How many coordinates count."""
        return len(self.coordinates)

    @property
    def is_whole(self) -> bool:
        """Whether all six count."""
        return self.size == len(COORDINATES)

    @cached_property
    def rows(self) -> tuple[int, ...]:
        """Their places among the six."""
        return tuple(COORDINATES.index(name) for name in self.coordinates)

    @cached_property
    def linear(self) -> int:
        """How many of them are displacements; they come first."""
        return sum(row < 3 for row in self.rows)

    @property
    def left_out(self) -> tuple[str, ...]:
        """The coordinates that do not count."""
        return tuple(name for name in COORDINATES if name not in self.coordinates)


def partial_difference(task: Task, pose: pin.SE3, jacobian: Array, target: pin.SE3) -> tuple[Array, Array]:
    """What is left to a target in the coordinates of a task, and how a joint step lessens it.

    `jacobian` (6, n) is that of the tool in its own frame. With E = pose^-1 target = (R, p) the six are
    p and log3 R; a step d of twist (v, w) changes them by -(v + w x p) and -Jlog3(R) R' w. Returns the
    coordinates (m,) and the matrix (m, n) to be multiplied by d; exact however far the free coordinates
    are apart, where the logarithm of the whole pose would mix them into the others.
    """
    apart = pose.actInv(target)
    p, turn = apart.translation, apart.rotation
    left = np.concatenate([p, pin.log3(turn)])
    # w x p = -[p]x w.
    moved = jacobian[:3] - pin.skew(p) @ jacobian[3:]
    turned = pin.Jlog3(turn) @ turn.T @ jacobian[3:]
    rows = list(task.rows)
    return left[rows], np.vstack([moved, turned])[rows]


def framed_difference(
    task: Task, frame: Array, pose: pin.SE3, jacobian: Array, turns: Array, target: pin.SE3
) -> tuple[Array, Array]:
    """`partial_difference` with the coordinates in another frame F, which joints turn.

    `frame` (3, 3) is the rotation of F in the world, `turns` (3, n) its angular velocity in its own axes by
    the joints; `jacobian` (6, n) still that of the tool in the tool frame. With T = (R, p) and the target
    (R*, p*) the six are F'(p* - p) and l = log3(F' R* R' F), the turn that leads from the tool to the target,
    seen from F. A step of tool twist (v, w) and frame turn f, all in F, changes them by -(v + f x p) and
    -(Jlog3(l) w + f x l). Where F is the tool frame these are those of `partial_difference`.
    """
    p = frame.T @ (target.translation - pose.translation)
    apart = frame.T @ target.rotation @ pose.rotation.T @ frame
    turn = pin.log3(apart)
    left = np.concatenate([p, turn])
    seen = frame.T @ pose.rotation
    # f x p = -[p]x f.
    moved = seen @ jacobian[:3] - pin.skew(p) @ turns
    turned = pin.Jlog3(apart) @ seen @ jacobian[3:] - pin.skew(turn) @ turns
    rows = list(task.rows)
    return left[rows], np.vstack([moved, turned])[rows]


def pose_errors(
    task: Task,
    wanted: tuple[Array, Array],
    reached: tuple[Array, Array],
    frames: Array | None = None,
) -> tuple[Array, Array]:
    """Distance (N,) m and angle (N,) rad between poses, in the coordinates that count.

    Poses are stacks of rotations (N, 3, 3) and positions (N, 3); `frames` (N, 3, 3) are the rotations of the
    frames that the coordinates are in, those reached where they are the tool's own.
    """
    if task.is_whole:
        return np.linalg.norm(wanted[1] - reached[1], axis=1), angles_between(reached[0], wanted[0])
    from scipy.spatial.transform import Rotation

    turn = Rotation.from_matrix(np.swapaxes(reached[0], 1, 2) @ wanted[0])
    seen = reached[0] if frames is None else frames
    away = np.einsum("nji,nj->ni", seen, wanted[1] - reached[1])
    vectors = turn.as_rotvec()
    if frames is not None:
        vectors = np.einsum("nji,njk,nk->ni", frames, reached[0], vectors)
    rows = np.array(task.rows)
    angles = vectors[:, rows[rows >= 3] - 3]
    return np.linalg.norm(away[:, rows[rows < 3]], axis=1), np.linalg.norm(angles, axis=1)
