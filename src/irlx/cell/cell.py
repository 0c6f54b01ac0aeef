"""A cell, ready for use: SI units, arrays, everything checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from irlx.blocks.link_frame import LinkFrame
from irlx.diagnostics import Diagnostic, Place
from irlx.robot.description import RobotDescription
from irlx.robot.limits import JointLimits
from irlx.robot.relation import Relation
from irlx.scene.scene import Scene

Array = NDArray[np.float64]


@dataclass(frozen=True)
class MotionDefaults:
    """Values the R_ variables start with, in program units: mm/s, mm/s2, deg/s, deg/s2, %, mm/s3, mm."""

    speed: float
    acc: float
    speed_ori: float
    acc_ori: float
    speed_ptp: float
    acc_ptp: float
    jerk: float = 0.0
    c_cp: float = 0.0
    c_ptp: float = 0.0
    c_pass: bool = False
    profile: str = "TRAPEZOID"
    override: float = 100.0


@dataclass(frozen=True)
class NamedFrame:
    """A pose of the cell: position in mm, unit quaternion scalar first."""

    position: tuple[float, float, float]
    quaternion: tuple[float, float, float, float]


@dataclass(frozen=True)
class RegisteredConstraint:
    """A constraint that a Python module is to register as `use`; `name` and `place` for messages."""

    name: str
    use: str
    place: Place


@dataclass(frozen=True)
class Cell:
    """Robot, limits (SI), least-motion weights (n,), start posture (n,) rad | m, tick and frames.

    `file` names the cell file for messages, `model` is the robot as the cell gives it; `relations` (SI) and
    `registered` constraints hold beside the tool pose. `inputs` are traces by casefolded name: times
    in s, and the value that holds from each on, 0 or 1 for a BOOL. `frames` stand still, `link_frames` move
    with a link of the robot.
    """

    file: str
    model: str
    robot: RobotDescription
    limits: JointLimits
    weights: Array
    start: Array
    tick_ns: int
    motion: MotionDefaults
    frames: Mapping[str, NamedFrame]
    warnings: tuple[Diagnostic, ...] = ()
    relations: tuple[Relation, ...] = ()
    registered: tuple[RegisteredConstraint, ...] = ()
    inputs: Mapping[str, tuple[tuple[float, float], ...]] = field(default_factory=dict)
    scene: Scene = field(default_factory=Scene)
    link_frames: Mapping[str, LinkFrame] = field(default_factory=dict)
