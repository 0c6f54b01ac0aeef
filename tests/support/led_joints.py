"""Packaged robots with joints made to follow others, and what leads back to all their joints."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from irlx.robot.description import Mimic, RobotDescription

CASES = {
    # Follower -> leader, multiplier, offset; leaders before and behind it, a chain of them, slides both ways.
    "rail6": {"joint_3": ("joint_2", -1.0, 0.0)},
    "arm7": {"joint_3": ("joint_2", -1.0, 0.2), "joint_2": ("joint_5", 0.5, -0.1)},
    "koch11": {"joint_4": ("joint_9", 2.0, 0.0), "joint_6": ("joint_4", -0.5, 0.3)},
    "mobile8": {"platform_y": ("platform_x", 0.5, 0.1), "joint_4": ("joint_5", -1.0, 0.0)},
}


def coupled(plain: RobotDescription, name: str) -> tuple[RobotDescription, np.ndarray, np.ndarray]:
    """The robot with followers, and A, b of q_plain = A q + b worked out here."""
    names = list(plain.joint_names)
    followers = {f: m for f, m in CASES[name].items() if f in names}
    assert len(followers) == len(CASES[name]), names
    joints = tuple(
        replace(joint, mimic=Mimic(*followers[joint.name])) if joint.name in followers else joint
        for joint in plain.joints
    )
    axes = [name for name in names if name not in followers]
    matrix, offsets = np.zeros((len(names), len(axes))), np.zeros(len(names))
    for row, joint in enumerate(names):
        factor, at = 1.0, joint
        while at in followers:
            leader, multiplier, offset = followers[at]
            offsets[row] += factor * offset
            factor *= multiplier
            at = leader
        matrix[row, axes.index(at)] = factor
    return replace(plain, joints=joints), matrix, offsets
