"""Where a robot would stand behind a move that it cannot do: how a dry run goes on."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.blocks import JointIncrement, MoveBlock, PoseIncrement, PoseTarget
from irlx.diagnostics import IrlxError, Place
from irlx.motion.plan_chain import Leg, plan_chain
from irlx.pacing.options import LimitsInForce
from irlx.pacing.path_moves import end_of_move
from irlx.pacing.posed import posed, posture_target
from irlx.pacing.situation import Situation
from irlx.pacing.switches import check_joint_target
from irlx.pacing.tolerance import posture_within, start_of

Array = NDArray[np.float64]


def needs_its_start(move: MoveBlock) -> bool:
    """Whether where a move ends depends on where it starts."""
    return any(
        isinstance(target, JointIncrement | PoseIncrement)
        or (isinstance(target, PoseTarget) and target.orientation is None)
        for target in move.targets
    )


def posture_beyond(situation: Situation, move: MoveBlock, in_force: LimitsInForce, place: Place) -> Array:
    """The posture (n,) of the end of a move: the one that is given, else the nearest one that reaches it.

    Raises PacingError where no posture within the limits does, and whatever the target of a move deserves.
    """
    given = posture_target(move.target, situation.q)
    if given is not None and (move.arc is None or move.arc.angle is None):
        end = np.array(given.values)
        check_joint_target(end, situation.robot, in_force.limits, place)
        return end
    start = start_of(situation, move.tolerance)
    told = posed(move, situation.kinematics, start, situation.q)
    rotation, position = end_of_move(told, start, place)
    x, y, z = position.tolist()
    kept = isinstance(told.target, PoseTarget) and told.target.orientation is None
    a, b, c, d = Rotation.from_matrix(rotation).as_quat().tolist()
    target = PoseTarget((x, y, z), None if kept else (a, b, c, d))
    return posture_within(move.tolerance, target, None, situation, in_force, place)


def ticks_beyond(situation: Situation, move: MoveBlock, place: Place) -> int:
    """Ticks that a move along a path is programmed to take, 0 where nobody can tell."""
    try:
        told = posed(move, situation.kinematics, situation.pose, situation.q)
        plan = plan_chain([Leg(replace(told, blend=None), place)], *situation.pose, situation.dt)
    except (IrlxError, TypeError):
        return 0
    return plan.ticks + 1
