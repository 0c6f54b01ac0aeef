"""Where a move ends: a pose, a posture, or one of them counted from where the move starts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias


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
class PoseIncrement:
    """Pose counted from the one that was demanded last: where the move starts, or the point before on a PATH.

    Without `orientation` it is a shift by `position` (m) along the axes of `frame`. With it (x, y, z, w)
    both are a pose d in the tool's own frame: target = start @ d.
    """

    position: tuple[float, float, float]
    orientation: tuple[float, float, float, float] | None
    frame: str = "R_BASE"


@dataclass(frozen=True)
class JointIncrement:
    """Posture counted from the one before: one difference a joint, rad or m."""

    values: tuple[float, ...]


Target: TypeAlias = PoseTarget | JointTarget | PoseIncrement | JointIncrement
