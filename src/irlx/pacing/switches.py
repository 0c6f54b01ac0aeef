"""Checks that a limit, a freeze or a target of the program fits the robot as it stands."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import FreezeBlock, JointRange, LimitClause, LimitKind, LimitSwitchBlock
from irlx.diagnostics import Diagnostic, Place, report
from irlx.pacing.errors import PacingError
from irlx.pacing.impossible import joint_values, outside_words
from irlx.pacing.options import LIMIT_WORDS
from irlx.robot.description import RobotDescription
from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]

_PER = {LimitKind.POSITION: "", LimitKind.SPEED: "/s", LimitKind.ACCELERATION: "/s2"}


def check_limit(
    limit: LimitSwitchBlock | LimitClause,
    robot: RobotDescription,
    limits: JointLimits,
    q: Array,
    place: Place,
) -> list[Diagnostic]:
    """Warnings of a limit that starts to hold at posture q (n,).

    Raises PacingError: IRL340 lower above upper, IRL342 a speed or acceleration range without zero,
    IRL345 a joint that stands outside. A bound wider than the robot's is a warning, IRL341.
    """
    if limit.range is None:
        return []
    errors = _range_errors(limit.kind, limit.range, robot, place)
    if errors:
        raise PacingError(errors)
    own_lower, own_upper = limits.pair(limit.kind.value.lower())
    lower, upper = np.maximum(own_lower, limit.range.lower), np.minimum(own_upper, limit.range.upper)
    if limit.kind is LimitKind.POSITION:
        check_inside(q, robot, limits.with_pair("position", lower, upper), place)
    return _wider(limit.kind, limit.range, robot, limits, place)


def check_inside(q: Array, robot: RobotDescription, limits: JointLimits, place: Place) -> None:
    """Raise PacingError, IRL345, for every joint of q (n,) outside the limits that hold from here."""
    lower, upper = limits.position_lower, limits.position_upper
    outside = np.flatnonzero((q < lower) | (q > upper))
    if outside.size:
        raise PacingError([_outside(int(joint), q, lower, upper, robot, place) for joint in outside])


def _range_errors(
    kind: LimitKind, joint_range: JointRange, robot: RobotDescription, place: Place
) -> list[Diagnostic]:
    """IRL340 for bounds the wrong way round, IRL342 for rates without standstill; all joints in one."""
    crossed, moving = [], []
    for joint, (lower, upper) in enumerate(zip(joint_range.lower, joint_range.upper, strict=True)):
        low, high = joint_values(robot, joint, lower, upper, per=_PER[kind])
        words = f"{robot.axes[joint].name} ({low} to {high})"
        if lower > upper:
            crossed.append(words)
        elif kind is not LimitKind.POSITION and not lower <= 0.0 <= upper:
            moving.append(words)
    found = [("IRL340", crossed), ("IRL342", moving)]
    return [
        report(code, place, word=LIMIT_WORDS[kind], joints=", ".join(joints))
        for code, joints in found
        if joints
    ]


def _outside(
    joint: int, q: Array, lower: Array, upper: Array, robot: RobotDescription, place: Place
) -> Diagnostic:
    side, passed = ("below", lower[joint]) if q[joint] < lower[joint] else ("above", upper[joint])
    value, bound = joint_values(robot, joint, float(q[joint]), float(passed))
    return report("IRL345", place, joint=robot.axes[joint].name, value=value, side=side, bound=bound)


def _wider(
    kind: LimitKind, joint_range: JointRange, robot: RobotDescription, limits: JointLimits, place: Place
) -> list[Diagnostic]:
    own_lower, own_upper = limits.pair(kind.value.lower())
    # Degrees turned into radians may pass the robot's bound by the last bit; nobody asked for more.
    slack = 1e-9
    wider = (np.array(joint_range.lower) < own_lower - slack) | (
        np.array(joint_range.upper) > own_upper + slack
    )
    if not np.any(wider):
        return []
    joints = ", ".join(robot.axes[joint].name for joint in np.flatnonzero(wider))
    return [report("IRL341", place, word=LIMIT_WORDS[kind], joints=joints)]


def check_frozen(block: FreezeBlock, robot: RobotDescription, place: Place) -> None:
    """Raise PacingError, IRL346, for a joint the robot does not have."""
    joints = len(robot.axes)
    unknown = [number for number in block.joints if not 1 <= number <= joints]
    if unknown:
        raise PacingError(report("IRL346", place, number=unknown[0], joints=joints))


def check_joint_target(q: Array, robot: RobotDescription, limits: JointLimits, place: Place) -> None:
    """Raise PacingError, IRL424, where a joint target (n,) lies outside the limits in force."""
    outside = np.flatnonzero((q < limits.position_lower) | (q > limits.position_upper))
    if outside.size == 0:
        return
    raise PacingError(
        [
            report("IRL424", place, **outside_words(robot, joint, q[joint], limits))
            for joint in (int(index) for index in outside)
        ]
    )
