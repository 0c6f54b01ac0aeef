"""What an interpreter knows of the machine: joints, and the values its system variables start with."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

SYSTEM_REALS = ("R_SPEED", "R_ACC", "R_SPEED_ORI", "R_ACC_ORI", "R_SPEED_PTP", "R_ACC_PTP")
"""System variables that give the defaults of the parameters of MOVE, in program units."""


@dataclass(frozen=True)
class Setting:
    """The robot's joints in order, which of them slide, and defaults in program units.

    `defaults` maps a name of `SYSTEM_REALS` to its value: mm/s, mm/s2, deg/s, deg/s2, %, %. `poses`
    are named poses of the cell: position in mm, quaternion scalar first.
    """

    joint_names: tuple[str, ...]
    prismatic: tuple[bool, ...]
    defaults: Mapping[str, float]
    poses: Mapping[str, tuple[tuple[float, float, float], tuple[float, float, float, float]]] = field(
        default_factory=dict
    )
