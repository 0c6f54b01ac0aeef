"""The verifier's own forward kinematics: the product of the chain's transforms."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from irlx.robot.description import Joint, JointKind, RobotDescription
from irlx.streams.joint_stream import Floats
from irlx.verifier.geometry.rotations import cross_matrix, from_rpy


def forward(robot: RobotDescription, q: Floats) -> tuple[Floats, Floats]:
    """Tool positions (N, 3) m and rotations (N, 3, 3) in the root frame for joint values q (N, n).

    Each joint of the chain contributes T(xyz, rpy) T(axis, value); fixed joints stand at zero, locked
    ones at their value, and what follows another joint at the value that it follows from.
    """
    poses = forward_of_links(robot, q, ())
    return poses[0], poses[1]


def forward_of_links(
    robot: RobotDescription, q: Floats, links: Collection[str]
) -> tuple[Floats, Floats, dict[str, Floats]]:
    """`forward`, and the rotations (N, 3, 3) of some links of the chain on the way."""
    rows = len(q)
    position = np.zeros((rows, 3))
    rotation = np.broadcast_to(np.eye(3), (rows, 3, 3)).copy()
    told, passed = values_of(robot, q), {}
    for joint in robot.chain:
        if joint.parent in links:
            passed[joint.parent] = rotation
        held = np.full(rows, robot.locked.get(joint.name, 0.0))
        position, rotation = after_joint(joint, told.get(joint.name, held), position, rotation)
    if robot.tip in links:
        passed[robot.tip] = rotation
    return position, rotation, passed


def values_of(robot: RobotDescription, q: Floats) -> dict[str, Floats]:
    """Values (N,) of all joints of the chain that move, by their names, at joint vectors q (N, n)."""
    found = {joint.name: q[:, column] for column, joint in enumerate(robot.axes)}
    waiting = [joint for joint in robot.moving if joint.name not in found]
    while waiting:
        joint = waiting.pop(0)
        mimic = joint.mimic
        if mimic is None or mimic.leader not in found:
            waiting.append(joint)
        else:
            found[joint.name] = mimic.multiplier * found[mimic.leader] + mimic.offset
    return found


def after_joint(joint: Joint, values: Floats, position: Floats, rotation: Floats) -> tuple[Floats, Floats]:
    """Poses of a joint's child from those of its parent, (N, 3) m and (N, 3, 3), at joint values (N,)."""
    position = position + rotation @ np.array(joint.xyz)
    rotation = _times(rotation, from_rpy(joint.rpy))
    if joint.kind is JointKind.FIXED:
        return position, rotation
    return _move(joint, values, position, rotation)


def _move(joint: Joint, values: Floats, position: Floats, rotation: Floats) -> tuple[Floats, Floats]:
    """Pose after the joint's own motion by values (N,): slide along, or turn about, its axis."""
    axis = np.array(joint.axis)
    if joint.is_prismatic:
        return position + (rotation @ axis) * values[:, None], rotation
    k = cross_matrix(axis)
    turned = _times(rotation, k)
    half = np.sin(0.5 * values)
    sine, versine = np.sin(values)[:, None, None], (2.0 * half * half)[:, None, None]
    return position, rotation + sine * turned + versine * _times(turned, k)


def _times(rotations: Floats, matrix: Floats) -> Floats:
    """Products (N, 3, 3) of a stack and one matrix: one tall product is far quicker than N small ones."""
    return (rotations.reshape(-1, 3) @ matrix).reshape(-1, 3, 3)
