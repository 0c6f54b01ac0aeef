"""The robot of a move WITH TOLERANCE: with virtual joints behind its tool."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Freed:
    """A `robot` of n joints and the same one `kinematics` with k virtual joints behind its tool.

    `joints` (n,) are the places of its own joints among the n + k; `limits` and `weights` are of all, and `q`
    (M, n + k) are postures: that of the start of a motion, then its rows.
    """

    robot: Kinematics
    kinematics: Kinematics
    joints: NDArray[np.int64]
    limits: JointLimits
    weights: Array
    q: Array
