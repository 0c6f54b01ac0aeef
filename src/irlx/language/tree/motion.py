"""Nodes of motion statements and of the switches of the redundancy extension."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from irlx.language.tree.expressions import Expression
from irlx.language.tree.nodes import Name, Node

MotionKind: TypeAlias = Literal["PTP", "LIN", "CIRCLE", "SPLINE"]
LimitKind: TypeAlias = Literal["POSITION", "SPEED", "ACCELERATION"]


@dataclass(frozen=True, slots=True)
class MoveParam(Node):
    """``NAME := value`` in a MOVE or after the name of a criterion."""

    name: Name
    value: Expression


@dataclass(frozen=True, slots=True)
class WithLimit(Node):
    """WITH JOINTLIMIT, JOINTSPEEDLIMIT or JOINTACCELLIMIT."""

    kind: LimitKind
    lower: Expression
    upper: Expression


@dataclass(frozen=True, slots=True)
class WithReconfiguration(Node):
    """WITH RECONFIGURATION; the parenthesised list of a PATH is already opened into `targets`."""

    targets: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class WithCriterion(Node):
    """WITH CRITERION name, with WEIGHT and the criterion's own parameters in `params`."""

    name: Name
    params: tuple[MoveParam, ...]


@dataclass(frozen=True, slots=True)
class WithTolerance(Node):
    """WITH TOLERANCE; `bands` is normally an aggregate of six numbers, mm and degrees."""

    bands: Expression


WithClause: TypeAlias = "WithLimit | WithReconfiguration | WithCriterion | WithTolerance"


@dataclass(frozen=True, slots=True)
class InFrame(Node):
    """IN FRAME name: the frame of the cell that poses count in and the tool is led in."""

    name: Name


@dataclass(frozen=True, slots=True)
class Move(Node):
    """MOVE or MOVE_INC (`incremental`); the parenthesised list of a PATH is opened into `targets`.

    `frames` are those of its IN FRAME; more than one is a mistake.
    """

    kind: MotionKind
    path: bool
    incremental: bool
    targets: tuple[Expression, ...]
    frames: tuple[InFrame, ...]
    params: tuple[MoveParam, ...]
    clauses: tuple[WithClause, ...]

    @property
    def frame(self) -> Name | None:
        """Name of the frame that it goes in, None for R_BASE."""
        return self.frames[0].name if self.frames else None


@dataclass(frozen=True, slots=True)
class LimitSwitch(Node):
    """JOINTLIMIT, JOINTSPEEDLIMIT or JOINTACCELLIMIT as a statement: in force until switched off."""

    kind: LimitKind
    lower: Expression
    upper: Expression


@dataclass(frozen=True, slots=True)
class LimitSwitchEnd(Node):
    """JOINTLIMITEND, JOINTSPEEDLIMITEND or JOINTACCELLIMITEND."""

    kind: LimitKind


@dataclass(frozen=True, slots=True)
class FreezeStart(Node):
    """FREEZESTART with the numbers of the joints to hold, counted from 1."""

    joints: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class FreezeEnd(Node):
    """FREEZEEND."""


@dataclass(frozen=True, slots=True)
class CyclicStart(Node):
    """CYCLICSTART."""


@dataclass(frozen=True, slots=True)
class CyclicEnd(Node):
    """CYCLICEND."""


@dataclass(frozen=True, slots=True)
class ObstacleStart(Node):
    """OBSTACLE name: keep clear of an obstacle or group of the cell."""

    name: Name


@dataclass(frozen=True, slots=True)
class ObstacleEnd(Node):
    """OBSTACLEEND name."""

    name: Name


@dataclass(frozen=True, slots=True)
class Reconfiguration(Node):
    """RECONFIGURATION target: a motion of the posture alone; `frame` is that in which the tool stays."""

    target: Expression
    frame: InFrame | None = None


@dataclass(frozen=True, slots=True)
class CriterionStart(Node):
    """CRITERION name, with WEIGHT and the criterion's own parameters in `params`."""

    name: Name
    params: tuple[MoveParam, ...]


@dataclass(frozen=True, slots=True)
class CriterionEnd(Node):
    """CRITERIONEND name."""

    name: Name
