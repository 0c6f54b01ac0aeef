"""A condition between joint values as plain data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from irlx.robot.axis_direction import AxisDirection
from irlx.robot.link_path import LinkPath


@dataclass(frozen=True)
class JointRelation:
    """One equation  sum of factor times joint value = value,  in rad and m.

    `factors` names the joints that take part, in any order; `name` is for messages, and `key`, its place in
    the cell file.
    """

    name: str
    factors: tuple[tuple[str, float], ...]
    value: float
    key: str = ""


Relation: TypeAlias = JointRelation | AxisDirection | LinkPath
"""A condition of a cell that plain data say all of."""
