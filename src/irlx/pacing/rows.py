"""The rows of one paced motion, and which bound held which joint in them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import MoveBlock, PauseBlock, ReconfigureBlock, WaitBlock
from irlx.motion.trapezoid import Trapezoid
from irlx.pacing.demand import Demand
from irlx.pacing.posture_term import PostureTerm
from irlx.pacing.slowing import Slowing
from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PathPart:
    """What a motion along a path has beside its rows.

    `demands` of the rows (the hold tick has none), posture `term` in force, the programmed `law`;
    `is_turn`: what counts is an angle, of `angle_per_s` rad for each unit of s; `planned`: the motion was
    planned as a whole because ordinary ticks would have broken a bound; `slowings`: the stretches that took
    longer than programmed; `free` (n,): the joints that were not frozen.
    """

    demands: tuple[Demand, ...]
    term: PostureTerm
    law: Trapezoid
    is_turn: bool
    angle_per_s: float
    planned: bool
    slowings: tuple[Slowing, ...]
    free: NDArray[np.bool_]


@dataclass(frozen=True)
class MotionRows:
    """What a move, reconfiguration or wait becomes: rows at consecutive ticks, the last one a hold.

    `q` (N, n) rad or m; `tool_position` (N, 3) m and `tool_rotation` (N, 3, 3) of the tool in the
    world; `path_position_error` (N,) m and `path_orientation_error` (N,) rad against the demanded
    pose; `active` (N, n): 0, or the sign of the side times (1 + BoundSource) of the bound that holds
    a joint back; `s` (N,) path parameter of `length`; `iterations` Newton steps in all;
    `limits` in force, None for the robot's own; `path`, None where no path was asked for.
    """

    block: MoveBlock | ReconfigureBlock | WaitBlock | PauseBlock
    first_tick: int
    q: Array
    tool_position: Array
    tool_rotation: Array
    path_position_error: Array
    path_orientation_error: Array
    active: NDArray[np.int8]
    s: Array
    length: float
    iterations: int
    limits: JointLimits | None = None
    path: PathPart | None = None

    def __len__(self) -> int:
        return int(self.q.shape[0])
