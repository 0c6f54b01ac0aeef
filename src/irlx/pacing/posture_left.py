"""Warnings about postures that RECONFIGURATION asks for and the robot cannot take."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.diagnostics import Diagnostic, Place, report
from irlx.pacing.impossible import joint_value, outside_words
from irlx.robot.description import RobotDescription
from irlx.robot.limits import JointLimits
from irlx.transform.posture_flow import FlowEnd

Array = NDArray[np.float64]

POSTURE_REACHED = 1e-6
"""Difference (rad or m) of a joint from the posture asked for that still counts as reached."""

ON_THE_WAY = "limits, frozen joints, the pose of the target or the way there kept it"
"""Why a move WITH RECONFIGURATION ends in another posture."""

NO_WAY = "a move of no length takes no time; the statement RECONFIGURATION moves the posture alone"
"""Why a move WITH RECONFIGURATION whose target is the present pose leaves the posture."""

JOINTS_GIVEN = "the target of this PTP is a posture itself, and that is taken"
"""Why a PTP to joint values does not heed the clause."""

_NO_NEARER = {
    FlowEnd.NEAREST: "this is the nearest one along the postures that keep the tool pose and the limits",
    FlowEnd.SINGULAR: "the arm is singular here, and no posture that keeps the tool pose is nearer",
    FlowEnd.STALLED: "no posture nearby that keeps the tool pose and the limits is nearer",
    FlowEnd.STEPS: "the way there is too long",
    FlowEnd.KONF: "it is reached but for rounding",
}


def why_left(end: FlowEnd, remaining: Array, held: NDArray[np.bool_], robot: RobotDescription) -> str:
    """Why a RECONFIGURATION stops short: how its flow ended, and the joints `held` (n,) from moving."""
    names = [robot.axes[i].name for i in np.flatnonzero(held & (np.abs(remaining) > POSTURE_REACHED))]
    only_held = names and not np.any(np.abs(remaining[~held]) > POSTURE_REACHED)
    words = [] if only_held else [_NO_NEARER[end]]
    if names:
        words.append(f"{', '.join(names)} {'is' if len(names) == 1 else 'are'} frozen or may not move")
    return "; ".join(words)


def posture_left(remaining: Array, why: str, robot: RobotDescription, place: Place) -> list[Diagnostic]:
    """IRL349 with the distance left for each joint, konf - end (n,), where one is left."""
    left = np.flatnonzero(np.abs(remaining) > POSTURE_REACHED)
    if left.size == 0:
        return []
    shares = [(robot.axes[joint].name, float(remaining[joint]), int(joint)) for joint in left]
    words = [f"{name} {joint_value(robot, joint, value)}" for name, value, joint in shares]
    return [report("IRL349", place, left=", ".join(words), why=why)]


def beyond_limits(
    konf: Array, limits: JointLimits, free: NDArray[np.bool_], robot: RobotDescription, place: Place
) -> list[Diagnostic]:
    """IRL350 for every free joint that a posture konf (n,) puts outside the position limits in force."""
    outside = free & ((konf < limits.position_lower) | (konf > limits.position_upper))
    return [
        report("IRL350", place, **outside_words(robot, joint, konf[joint], limits))
        for joint in (int(index) for index in np.flatnonzero(outside))
    ]
