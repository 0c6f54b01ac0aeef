"""Joints: limits, axes, and numbers whose unit may be another one."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees, pi

from irlx.cell.robot_check.findings import ModelFindings, joint_key, length_of
from irlx.cell.robot_check.model_text import JointText

_MOST_TURN = 4.0 * pi
_FAR = 50.0
"""Beyond this, m, a slide or a link is longer than machines are; so much is common in mm."""

_FASTEST = {False: 50.0, True: 20.0}
"""Beyond these, rad/s and m/s, no joint of a robot goes; as degrees and mm a second they are common."""

_UNIT = 1e-3
_LEAST_CHAIN = 0.02


def check_joints(joints: Sequence[JointText], findings: ModelFindings) -> None:
    """Findings on joints that move the tool: IRL650 to IRL653, IRL658, IRL659, IRL663, IRL665."""
    moving = [joint for joint in joints if joint.moves]
    for joint in moving:
        _check_axis(joint, findings)
        if joint.mimics is not None:
            findings.tell("IRL665", joint_key(joint.name), joint=joint.name, other=joint.mimics)
            continue
        _check_positions(joint, findings)
        _check_speed(joint, findings)
    if moving:
        findings.tell("IRL653")


def check_lengths(joints: Sequence[JointText], findings: ModelFindings) -> None:
    """Joints that lie farther from the one before than robots are large, and chains of no size: IRL660."""
    for joint in joints:
        length = length_of(joint.xyz)
        if length > _FAR:
            what, found = f"{joint.name} lies", f"{length:.6g} m from the frame of '{joint.parent}'"
            findings.tell("IRL660", joint_key(joint.name), what=what, found=found)
    whole = sum(length_of(joint.xyz) for joint in joints)
    if 0.0 < whole < _LEAST_CHAIN and sum(joint.moves for joint in joints) > 1:
        findings.tell("IRL660", what="the whole chain of joints is", found=f"{whole * 1e3:.6g} mm long")


def _check_positions(joint: JointText, findings: ModelFindings) -> None:
    key, lower, upper = joint_key(joint.name), joint.lower, joint.upper
    if joint.kind == "continuous":
        findings.tell("IRL650", key, joint=joint.name, cause="it turns without end (continuous)")
        return
    missing = [word for word, limit in (("lower", lower), ("upper", upper)) if limit is None]
    if missing:
        cause = f"its <limit> has no {' and no '.join(missing)}"
        findings.tell("IRL650", key, joint=joint.name, cause=cause)
    if lower is not None and lower == upper:
        cause = f"its lower and its upper limit are both {lower:g}"
        findings.tell("IRL651", key, joint=joint.name, cause=cause)
    farthest = max(abs(lower or 0.0), abs(upper or 0.0))
    if joint.slides and farthest > _FAR:
        found, other = f"{farthest:.6g} m", "millimetres"
        findings.tell("IRL658", key, joint=joint.name, found=found, other=other, unit="m")
    elif not joint.slides and farthest > _MOST_TURN:
        found, other = f"{farthest:.6g} rad, {farthest / (2 * pi):.3g} turns", "degrees"
        findings.tell("IRL658", key, joint=joint.name, found=found, other=other, unit="rad")


def _check_speed(joint: JointText, findings: ModelFindings) -> None:
    key, speed = joint_key(joint.name), joint.speed
    if speed is None:
        findings.tell("IRL652", key, joint=joint.name)
    elif speed == 0.0:
        findings.tell("IRL651", key, joint=joint.name, cause="its speed limit (velocity) is 0")
    elif speed > _FASTEST[joint.slides]:
        found = f"{speed:.6g} m/s" if joint.slides else f"{speed:.6g} rad/s, {degrees(speed):.6g} deg/s"
        other = "millimetres" if joint.slides else "degrees"
        findings.tell("IRL659", key, joint=joint.name, found=found, other=other)


def _check_axis(joint: JointText, findings: ModelFindings) -> None:
    key = joint_key(joint.name)
    if joint.axis is None:
        findings.tell("IRL663", key, joint=joint.name, cause="none is given, and x counts")
        return
    length = length_of(joint.axis)
    # Without any direction the reader refuses the joint.
    if length > 0.0 and abs(length - 1.0) > _UNIT:
        findings.tell("IRL663", key, joint=joint.name, cause=f"its length is {length:.6g}, not 1")
