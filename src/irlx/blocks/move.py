"""The block of one move: kind, target, course, time law, and the limit clauses that hold for it alone."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from irlx.blocks.block import Block
from irlx.blocks.criterion import CriterionClause
from irlx.blocks.options import LimitClause


class MoveKind(str, Enum):
    """How the tool gets to the target."""

    PTP = "PTP"
    LIN = "LIN"
    CIRCLE = "CIRCLE"


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
class ArcCourse:
    """How a CIRCLE gets to its target: through `via`, and on by `angle` where the program gives one.

    `angle` in rad, not 0, from the start of the move, negative backwards: the target's position then fixes
    only the plane, and its orientation is that at the end. `turns_through_via` makes the orientation of
    `via` count; otherwise only its position does. `via_reconfiguration` is the posture to be drawn to on the
    way to `via`, beside the move's own `reconfiguration`.
    """

    via: PoseTarget | JointTarget
    angle: float | None = None
    turns_through_via: bool = False
    via_reconfiguration: JointTarget | None = None


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
    """One move of the tool (LIN, CIRCLE) or of the joints (PTP) to a target; a CIRCLE has a `course`.

    `reconfiguration`: posture to be drawn to on the way, the target's pose being kept (of a CIRCLE with a
    posture for its via point: on the way from there); the cyclic option is off for such a move. `criteria`
    are added for this move alone.
    """

    kind: MoveKind
    target: PoseTarget | JointTarget
    law: MotionLaw
    limits: tuple[LimitClause, ...] = ()
    course: ArcCourse | None = None
    reconfiguration: JointTarget | None = None
    criteria: tuple[CriterionClause, ...] = ()
