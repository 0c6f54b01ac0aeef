"""What an interpreter knows of the machine: joints, and the values its system variables start with."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from irlx.blocks import LinkFrame

Default = float | bool | str

SYSTEM_REALS = (
    "R_SPEED",
    "R_ACC",
    "R_SPEED_ORI",
    "R_ACC_ORI",
    "R_SPEED_PTP",
    "R_ACC_PTP",
    "R_JERK",
    "R_C_CP",
    "R_C_PTP",
    "R_OVERRIDE",
)
"""System variables that give defaults of parameters of MOVE that are numbers, in program units."""

UNSAID: Mapping[str, Default] = {
    "R_JERK": 0.0,
    "R_C_CP": 0.0,
    "R_C_PTP": 0.0,
    "R_C_PASS": False,
    "R_PROFILE": "TRAPEZOID",
    "R_OVERRIDE": 100.0,
}
"""Defaults that ask for nothing: what holds where nobody says anything else."""


@dataclass(frozen=True)
class Setting:
    """The robot's joints in order, which of them slide, and defaults in program units.

    `defaults` maps names of system variables to the values that they start with: mm/s, mm/s2, deg/s, deg/s2,
    %, mm/s3, mm. `poses` are named poses of the cell in the root frame of the robot: position in mm,
    quaternion scalar first. `weights` are those of the joints, 1 each where none are given. `robots` are the
    names by which ROBOT may call the robot. `obstacles` are those of the cell, and its groups, by casefolded
    name as the cell writes them; None where nobody knows the cell, and any name may be one. `frames` move
    with a link of the robot, by casefolded name.
    """

    joint_names: tuple[str, ...]
    prismatic: tuple[bool, ...]
    defaults: Mapping[str, Default]
    poses: Mapping[str, tuple[tuple[float, float, float], tuple[float, float, float, float]]] = field(
        default_factory=dict
    )
    weights: tuple[float, ...] = ()
    robots: tuple[str, ...] = ()
    obstacles: Mapping[str, str] | None = None
    frames: Mapping[str, LinkFrame] = field(default_factory=dict)

    def default(self, name: str) -> Default:
        """What the system variable of a name starts with."""
        return self.defaults[name] if name in self.defaults else UNSAID[name]
