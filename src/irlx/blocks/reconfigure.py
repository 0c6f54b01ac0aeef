"""The block of a reconfiguration: a motion of the posture alone, the tool stays where it is."""

from __future__ import annotations

from dataclasses import dataclass

from irlx.blocks.block import Block
from irlx.blocks.link_frame import LinkFrame
from irlx.blocks.move import MotionLaw
from irlx.blocks.targets import JointTarget


@dataclass(frozen=True, kw_only=True)
class ReconfigureBlock(Block):
    """Move to the posture `target`, or to the nearest one that keeps the tool pose and the limits.

    `law` is latched when the statement ran: joints without a speed limit move with its `speed` (slides) or
    `speed_ori` (turns). With `frame` the tool keeps its pose in that frame, which moves with a link.
    """

    target: JointTarget
    law: MotionLaw
    frame: LinkFrame | None = None
