"""What the checks of one stream share: its outline, the robot, the moves, and the limits in force."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from irlx.blocks import JointTarget, PoseTarget, Target
from irlx.robot.description import RobotDescription
from irlx.robot.relation import JointRelation
from irlx.streams.joint_stream import Floats
from irlx.verifier.findings.tally import Tally
from irlx.verifier.geometry.forward import forward
from irlx.verifier.geometry.rotations import from_quaternion
from irlx.verifier.limits import LimitsInForce, limits_in_force
from irlx.verifier.moves import MoveRows, moves_of
from irlx.verifier.outline import Outline

Pose = tuple[Floats, Floats]
"""Position (3,) m and rotation (3, 3) of the tool."""

BASE_FRAME = "R_BASE"
"""The frame of targets that the verifier can place: the root of the robot."""


@dataclass(frozen=True)
class Evidence:
    """The outline of a stream with what follows from it, computed on first use.

    `robot` is None where none is known or where it is not the stream's robot; `start` (n,) is the posture in
    which its cell has it begin, None where no cell is given; `relations` between joints are its cell's.
    """

    outline: Outline
    robot: RobotDescription | None
    start: Floats | None = None
    relations: tuple[JointRelation, ...] = ()

    @cached_property
    def moves(self) -> list[MoveRows]:
        """The recorded moves in order."""
        return moves_of(self.outline)

    @cached_property
    def limits(self) -> LimitsInForce:
        """The limits in force at each row."""
        return limits_in_force(self.outline, self.moves)

    def posture(self, row: int) -> Floats:
        """Joint values (n,) of a row in which a block ends."""
        return np.array(self.outline.posture(row))

    def target_pose(self, target: Target, start: Pose) -> Pose | None:
        """Pose of a target or via point of a move that starts at a pose; None: its frame is not known."""
        if isinstance(target, JointTarget):
            assert self.robot is not None
            positions, rotations = forward(self.robot, np.array([target.values], dtype=np.float64))
            return positions[0], rotations[0]
        if not isinstance(target, PoseTarget) or target.frame != BASE_FRAME:
            return None
        if target.orientation is None:
            return np.array(target.position), start[1]
        quaternion = np.array(target.orientation)
        return np.array(target.position), from_quaternion(quaternion / np.linalg.norm(quaternion))

    def tally(self, name: str, unit: str) -> Tally:
        """An empty tally for a check of this stream."""
        return Tally(name, unit, self.outline)
