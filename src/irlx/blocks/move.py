"""The block of one move: kind, target, time law, and the limit clauses that hold for it alone."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from irlx.blocks.block import Block
from irlx.blocks.options import LimitClause


class MoveKind(str, Enum):
    """How the tool gets to the target."""

    PTP = "PTP"
    LIN = "LIN"


@dataclass(frozen=True)
class PoseTarget:
    """Pose of the tool in a named frame.

    `position` in m; `orientation` as unit quaternion (x, y, z, w), or None to keep the orientation
    that the tool has at the start of the move.
    """

    position: tuple[float, float, float]
    orientation: tuple[float, float, float, float] | None
    frame: str = "R_BASE"


@dataclass(frozen=True)
class JointTarget:
    """Posture: one value a joint, rad or m."""

    values: tuple[float, ...]


@dataclass(frozen=True)
class MotionLaw:
    """Upper bounds of the programmed motion, latched when the statement ran.

    `speed` m/s, `acc` m/s2, `speed_ori` rad/s, `acc_ori` rad/s2; `speed_ptp` and `acc_ptp` as
    fractions of the joints' own limits; `duration` in s where the program asks for one.
    """

    speed: float
    acc: float
    speed_ori: float
    acc_ori: float
    speed_ptp: float = 1.0
    acc_ptp: float = 1.0
    duration: float | None = None


@dataclass(frozen=True, kw_only=True)
class MoveBlock(Block):
    """One move of the tool (LIN) or of the joints (PTP) to a target."""

    kind: MoveKind
    target: PoseTarget | JointTarget
    law: MotionLaw
    limits: tuple[LimitClause, ...] = ()
