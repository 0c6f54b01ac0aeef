"""A condition between joint values as plain data."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class JointRelation:
    """One equation  sum of factor times joint value = value,  in rad and m.

    `factors` names the joints that take part, in any order; `name` is for messages.
    """

    name: str
    factors: tuple[tuple[str, float], ...]
    value: float
