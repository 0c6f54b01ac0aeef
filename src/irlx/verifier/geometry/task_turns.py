"""Which turns of the tool count: all of them, or some about the axes of a frame that the joints turn.

An attitude is a rotation (3, 3) alone where all turns count. Else it is (9, 3): below the rotation the axes
of the frame in the world, as rows, first those about which turns are asked for, then those about which they
follow from what is asked for; rows of the other axes are zero.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.robot.description import JointKind, RobotDescription
from irlx.streams.joint_stream import Floats
from irlx.verifier.geometry.forward import forward_of_links
from irlx.verifier.geometry.rotations import angle_between, rotation_vectors

TURNS = ("rx", "ry", "rz")
POSTURES = 5
STILL = 1e-9
"""Part of a joint's axis along an axis of the frame below which it turns the tool about that not at all."""


@dataclass(frozen=True, eq=False)
class TaskTurns:
    """The turns that count for one robot: masks (3,), 1 or 0, of axes of the link `frame`, or the tool's."""

    robot: RobotDescription
    frame: str | None
    asked: Floats
    followed: Floats

    @classmethod
    def of(cls, robot: RobotDescription) -> TaskTurns | None:
        """None where all turns count: no other ones are left out than those that no joint makes."""
        left = np.array([name not in robot.coordinates for name in TURNS])
        free = np.array([name in robot.free for name in TURNS])
        followed = left & ~free
        if not free.any() and not (followed & _moved(robot)).any():
            return None
        return cls(robot, robot.task_frame, (~left).astype(np.float64), followed.astype(np.float64))

    def frames(self, q: Floats) -> Floats | None:
        """Rotations (N, 3, 3) of the link that is the frame, at postures q (N, n); None for the tool."""
        if self.frame is None:
            return None
        return forward_of_links(self.robot, q, (self.frame,))[2][self.frame]

    def attitudes(self, rotations: Floats, frames: Floats | None) -> Floats:
        """Attitudes (N, 9, 3) of tools of rotations (N, 3, 3)."""
        axes = np.swapaxes(rotations if frames is None else frames, 1, 2)
        asked, followed = self.asked[:, None] * axes, self.followed[:, None] * axes
        return np.concatenate([rotations, asked, followed], axis=1)


def turned_off(attitudes: Floats, wanted: Floats) -> Floats:
    """Angle (N,) rad of attitudes (N, ..) off rotations (N, 3, 3) or (3, 3), in the turns asked for."""
    if attitudes.shape[-2] == 3:
        return angle_between(attitudes, wanted)
    return _about(attitudes, wanted, slice(3, 6))


def turned_from(attitudes: Floats, start: Floats, turned: Floats) -> Floats:
    """`turned_off` from a rotation `start` (3, 3) with `turned` (N, 3, 3), in its axes, behind it."""
    if attitudes.shape[-2] == 3:
        return angle_between(start.T @ attitudes, turned)
    return turned_off(attitudes, start @ turned)


def followed_off(attitudes: Floats, wanted: Floats) -> Floats:
    """The same (N,) in the turns that follow; 0 where all turns are asked for."""
    if attitudes.shape[-2] == 3:
        return np.zeros(len(attitudes))
    return _about(attitudes, wanted, slice(6, 9))


def turns_asked(attitudes: Floats, wanted: Floats) -> Floats:
    """The turn (N, 3) rad that leads from attitudes (N, 9, 3) to rotations, about the axes asked for."""
    vectors = rotation_vectors(wanted @ np.swapaxes(attitudes[:, :3], 1, 2))
    return np.asarray((attitudes[:, 3:6] @ vectors[:, :, None])[:, :, 0])


def _about(attitudes: Floats, wanted: Floats, axes: slice) -> Floats:
    vectors = rotation_vectors(wanted @ np.swapaxes(attitudes[:, :3], 1, 2))
    return np.asarray(np.linalg.norm((attitudes[:, axes] @ vectors[:, :, None])[:, :, 0], axis=1))


def _moved(robot: RobotDescription) -> NDArray[np.bool_]:
    """About which axes (3,) of the frame joints turn the tool at postures without any pattern."""
    count = len(robot.axes)
    q = np.sin(np.outer(1.7 + np.arange(POSTURES), np.arange(1.0, count + 1.0)))
    moving = [joint for joint in robot.moving if joint in robot.chain]
    links = [joint.child for joint in moving]
    frame = robot.tip if robot.task_frame is None else robot.task_frame
    _, _, rotations = forward_of_links(robot, q, {frame, *links})
    found = np.zeros(3, dtype=np.bool_)
    for joint in moving:
        if joint.kind is not JointKind.PRISMATIC:
            axes = rotations[joint.child] @ np.array(joint.axis)
            seen = np.einsum("nji,nj->ni", rotations[frame], axes)
            found |= (np.abs(seen) > STILL).any(axis=0)
    return found
