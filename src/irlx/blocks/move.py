"""The block of one move: kind, target, course, time law, and the limit clauses that hold for it alone."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from irlx.blocks.block import Block
from irlx.blocks.criterion import CriterionClause
from irlx.blocks.link_frame import LinkFrame
from irlx.blocks.options import LimitClause
from irlx.blocks.targets import JointTarget, Target
from irlx.blocks.tolerance import ToleranceClause


class MoveKind(str, Enum):
    """How the tool gets to the target."""

    PTP = "PTP"
    LIN = "LIN"
    CIRCLE = "CIRCLE"
    SPLINE = "SPLINE"


class Profile(str, Enum):
    """Shape of a motion's time law: constant acceleration, or acceleration that jerk leads in and out."""

    TRAPEZOID = "TRAPEZOID"
    S_CURVE = "S_CURVE"


@dataclass(frozen=True)
class ArcCourse:
    """How a CIRCLE gets to its target: through `via`, and on by `angle` where the program gives one.

    `angle` in rad, not 0, from the start of the move, negative backwards: the target's position then fixes
    only the plane, and its orientation is that at the end. `turns_through_via` makes the orientation of
    `via` count; otherwise only its position does. `via_reconfiguration` is the posture to be drawn to on the
    way to `via`, beside the move's own `reconfiguration`.
    """

    via: Target
    angle: float | None = None
    turns_through_via: bool = False
    via_reconfiguration: JointTarget | None = None


@dataclass(frozen=True)
class PathCourse:
    """The points that a LIN or SPLINE along a PATH runs through before its target.

    A LIN goes straight from point to point, and round the points by the move's `blend`; a SPLINE is one
    smooth curve through all of them. `reconfigurations`: none, or the posture to be drawn to at each of them,
    beside the move's own `reconfiguration` at its target.
    """

    points: tuple[Target, ...]
    reconfigurations: tuple[JointTarget, ...] = ()


@dataclass(frozen=True)
class Blend:
    """How a move passes its target on the way to the next one, instead of stopping there.

    `distance` (m, C_CP) of moves of the tool: how far from the target the path leaves and joins the
    programmed ones; None: no farther than the programmed speed needs (C_PASS). `share` (C_PTP) of a PTP: the
    same as a part 0..1 of half the shorter of both ways in joint space; None: all of it.
    """

    distance: float | None = None
    share: float | None = None


@dataclass(frozen=True)
class MotionLaw:
    """Upper bounds of the programmed motion, latched when the statement ran.

    `speed` m/s, `acc` m/s2, `speed_ori` rad/s, `acc_ori` rad/s2; `speed_ptp` and `acc_ptp` as
    fractions of the joints' own limits; `duration` in s where the program asks for one. `jerk` m/s3 leads
    the acceleration of an S curve in and out. `override` in 0..1 scales time: the motion takes 1/override
    of its time.
    """

    speed: float
    acc: float
    speed_ori: float
    acc_ori: float
    speed_ptp: float = 1.0
    acc_ptp: float = 1.0
    duration: float | None = None
    profile: Profile = Profile.TRAPEZOID
    jerk: float | None = None
    override: float = 1.0


@dataclass(frozen=True, kw_only=True)
class MoveBlock(Block):
    """One move of the tool (LIN, CIRCLE, SPLINE) or of the joints (PTP) to a target.

    A CIRCLE has an `ArcCourse`, a move along a PATH a `PathCourse`. With `blend` it passes its target where
    the next move allows it, and the inner points of its own path.
    `reconfiguration`: posture to be drawn to on the way, the target's pose being kept (of a CIRCLE with a
    posture for its via point: on the way from there); the cyclic option is off for such a move. `criteria`
    are added for this move alone. `tolerance`: bands within which the tool may stand off its programmed pose.
    In a `frame` that moves with a link all poses count, and the path and the speeds of its law: they are
    what that frame sees of the tool.
    """

    kind: MoveKind
    target: Target
    law: MotionLaw
    limits: tuple[LimitClause, ...] = ()
    course: ArcCourse | PathCourse | None = None
    reconfiguration: JointTarget | None = None
    criteria: tuple[CriterionClause, ...] = ()
    blend: Blend | None = None
    tolerance: ToleranceClause | None = None
    frame: LinkFrame | None = None

    @property
    def arc(self) -> ArcCourse | None:
        """The course of a CIRCLE, None of all others."""
        return self.course if isinstance(self.course, ArcCourse) else None

    @property
    def path(self) -> PathCourse | None:
        """The course of a move along a PATH, None of all others."""
        return self.course if isinstance(self.course, PathCourse) else None

    @property
    def targets(self) -> tuple[Target, ...]:
        """All that the move runs through in order: via point of a CIRCLE, points of a PATH, the target."""
        if self.course is None:
            return (self.target,)
        inner = (self.course.via,) if isinstance(self.course, ArcCourse) else self.course.points
        return (*inner, self.target)
