"""What the checks of one stream share: the stream, the robot, its moves, limits and tool poses."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from irlx.blocks import JointTarget, MoveBlock, PoseTarget, ReconfigureBlock
from irlx.robot.description import RobotDescription
from irlx.streams.joint_stream import Floats, JointStream
from irlx.verifier.arcs import ArcShape, arc_shape
from irlx.verifier.forward import forward
from irlx.verifier.limits import LimitsInForce, limits_in_force
from irlx.verifier.moves import MoveRows, moves_of
from irlx.verifier.rotations import from_quaternion
from irlx.verifier.tally import Tally

Pose = tuple[Floats, Floats]
"""Position (3,) m and rotation (3, 3) of the tool."""

BASE_FRAME = "R_BASE"
"""The frame of targets that the verifier can place: the root of the robot."""


@dataclass(frozen=True)
class Evidence:
    """One stream with everything that follows from it, computed on first use.

    `robot` is None where none was given or where it is not the stream's robot.
    """

    stream: JointStream
    robot: RobotDescription | None

    @cached_property
    def lines(self) -> dict[int, int]:
        """Program line of every recorded block, by id."""
        return {record.block.id: record.block.origin.line for record in self.stream.records}

    @cached_property
    def moves(self) -> list[MoveRows]:
        """The recorded moves in order."""
        return moves_of(self.stream)

    @cached_property
    def limits(self) -> LimitsInForce:
        """The limits in force at each row."""
        return limits_in_force(self.stream, self.moves)

    @cached_property
    def poses(self) -> tuple[Floats, Floats]:
        """Tool positions (N, 3) and rotations (N, 3, 3) by the verifier's own forward kinematics."""
        assert self.robot is not None
        return forward(self.robot, self.stream.q)

    def pose(self, row: int) -> Pose:
        """Tool position (3,) and rotation (3, 3) of one row."""
        positions, rotations = self.poses
        return positions[row], rotations[row]

    def goal(self, move: MoveRows) -> Pose | None:
        """Pose that a move must reach; None where its target stands in a frame that is not known here."""
        target = self.target_pose(move.block.target, move)
        course = move.block.course
        if target is None or course is None or course.angle is None:
            return target
        shape = self.arc(move)
        return target if shape is None else (shape.end, target[1])

    def target_pose(self, target: PoseTarget | JointTarget, move: MoveRows) -> Pose | None:
        """Pose of a target or via point of a move; None where its frame is not known here."""
        if not isinstance(target, PoseTarget):
            assert self.robot is not None
            positions, rotations = forward(self.robot, np.array([target.values], dtype=np.float64))
            return positions[0], rotations[0]
        if target.frame != BASE_FRAME:
            return None
        if target.orientation is None:
            return np.array(target.position), self.pose(move.start)[1]
        quaternion = np.array(target.orientation)
        return np.array(target.position), from_quaternion(quaternion / np.linalg.norm(quaternion))

    def arc(self, move: MoveRows) -> ArcShape | None:
        """The arc of a CIRCLE; None where its points make no circle, or stand in an unknown frame."""
        course = move.block.course
        assert course is not None
        via, end = (self.target_pose(target, move) for target in (course.via, move.block.target))
        if via is None or end is None:
            return None
        return arc_shape(self.pose(move.start)[0], via[0], end[0], course.angle)

    def tally(self, name: str, unit: str) -> Tally:
        """An empty tally for a check of this stream."""
        return Tally(name, unit, self.stream, self.lines)

    @property
    def carries_blocks(self) -> bool:
        """Whether moves are recorded; some formats carry samples only."""
        motions = MoveBlock | ReconfigureBlock
        recorded = any(isinstance(record.block, motions) for record in self.stream.records)
        return recorded or not self.stream.block.any()
