"""The moving frames that blocks name, and the tool as it is seen from them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from irlx.blocks import LinkFrame, MoveBlock, ReconfigureBlock
from irlx.robot.description import RobotDescription
from irlx.streams.joint_stream import BlockRecord, Floats, Integers
from irlx.verifier.geometry.link_poses import link_poses
from irlx.verifier.geometry.rotations import from_quaternion
from irlx.verifier.tools import Pose


@dataclass(frozen=True, eq=False)
class FramesInForce:
    """Frames that move with links of a robot, by the ids of the blocks whose poses count in them."""

    robot: RobotDescription | None
    of_block: Mapping[int, LinkFrame]

    def seen(self, poses: Pose, q: Floats, blocks: Integers) -> Pose:
        """Poses (R, 3), (R, 3, 3) in the world as the frames of the blocks (R,) of their rows see them.

        `q` (R, n) are the postures of the rows. A frame of no link of the robot sees no numbers.
        """
        if not self.of_block or self.robot is None:
            return poses
        named = [block for block in np.unique(blocks).tolist() if block in self.of_block]
        if not named:
            return poses
        positions, rotations = poses[0].copy(), poses[1].copy()
        for block in named:
            rows = blocks == block
            frame = self.of_block[block]
            positions[rows], rotations[rows] = self.seen_from(
                frame, (poses[0][rows], poses[1][rows]), q[rows]
            )
        return positions, rotations

    def seen_from(self, frame: LinkFrame | None, poses: Pose, q: Floats) -> Pose:
        """Poses (R, 3), (R, 3, 3) in the world as one frame sees them at postures q (R, n)."""
        if frame is None or self.robot is None:
            return poses
        at, turned = self._frames(frame, q)
        backward = np.swapaxes(turned, 1, 2)
        return (backward @ (poses[0] - at)[:, :, None])[:, :, 0], backward @ poses[1]

    def _frames(self, frame: LinkFrame, q: Floats) -> Pose:
        """Positions and rotations, (R, ..) or of a link that rests (1, ..), of a frame in the world."""
        robot = self.robot
        if robot is None or frame.link not in {robot.root, *(joint.child for joint in robot.joints)}:
            return np.full((1, 3), np.nan), np.full((1, 3, 3), np.nan)
        position, rotation = link_poses(robot, q, (frame.link,))[frame.link]
        quaternion = np.array(frame.orientation)
        inside = from_quaternion(quaternion / np.linalg.norm(quaternion))
        return position + rotation @ np.array(frame.position), rotation @ inside


def frames_of(records: Sequence[BlockRecord], robot: RobotDescription | None) -> FramesInForce:
    """The frames that the blocks of a stream name."""
    blocks = (record.block for record in records)
    found = {
        block.id: block.frame
        for block in blocks
        if isinstance(block, MoveBlock | ReconfigureBlock) and block.frame is not None
    }
    return FramesInForce(robot, found)
