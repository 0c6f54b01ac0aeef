"""Moves in frames that move with a link: how the robot is seen from such a frame."""

from __future__ import annotations

from typing import Any

from irlx.blocks import Block, LinkFrame, MoveBlock, MoveKind, ReconfigureBlock
from irlx.diagnostics import Place, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.pacing.errors import PacingError
from irlx.robot.kinematics import Kinematics


def frame_of(block: Block) -> LinkFrame | None:
    """The frame in which a block leads the tool or keeps it, None for the world."""
    leads = isinstance(block, ReconfigureBlock) or (
        isinstance(block, MoveBlock) and block.kind is not MoveKind.PTP
    )
    return block.frame if leads and isinstance(block, MoveBlock | ReconfigureBlock) else None


def seen_from(kinematics: Kinematics, frame: LinkFrame | None, place: Place) -> Kinematics:
    """The robot with the poses of its tool told in a frame, None for the world; for motions to poses.

    Constraints that the pose implies are no rows there. Raises PacingError: IRL515 where it has no such link,
    as in a stream of another robot; IRL442 where its task leaves turns of the tool to the joints.
    """
    if frame is None:
        return kinematics.of_pose
    robot = kinematics.description
    links = (robot.root, *(joint.child for joint in robot.joints))
    if frame.link not in links:
        data: dict[str, Any] = {"name": frame.name, "link": frame.link, "robot": robot.name}
        raise PacingError(report("IRL515", place, near=near_matches(frame.link, links), **data))
    if kinematics.leaves_turns:
        left = ", ".join(kinematics.task.left_out)
        raise PacingError(report("IRL442", place, frame=frame.name, robot=robot.name, left=left))
    return kinematics.relative_to(frame).of_pose
