"""The verifier's own forward kinematics: the product of the chain's transforms."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from irlx.robot.description import Joint, JointKind, RobotDescription
from irlx.streams.joint_stream import Floats
from irlx.verifier.geometry.rotations import cross_matrix, from_rpy

RowsLast = tuple[Floats, Floats]
"""Positions (3, N) m and rotations (3, 3, N); N is 1 where one pose stands for all rows. With the row last
numpy works on whole columns."""

ROOT: RowsLast = (np.zeros((3, 1)), np.eye(3)[:, :, None])


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
    told, passed, rows = values_of(robot, q), {}, len(q)
    pose = ROOT
    for joint in robot.chain:
        if joint.parent in links:
            passed[joint.parent] = rows_first(pose, rows)[1]
        pose = after_joint(joint, told.get(joint.name, held_at(robot, joint)), pose)
    if robot.tip in links:
        passed[robot.tip] = rows_first(pose, rows)[1]
    return *rows_first(pose, rows), passed


def held_at(robot: RobotDescription, joint: Joint) -> Floats:
    """Value (1,) of a joint that no axis moves."""
    return np.array([robot.locked.get(joint.name, 0.0)])


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


def after_joint(joint: Joint, values: Floats, pose: RowsLast) -> RowsLast:
    """Pose of a joint's child from that of its parent, at joint values (N,) or (1,)."""
    position, rotation = pose
    if any(joint.xyz):
        position = position + np.array(joint.xyz) @ rotation
    if any(joint.rpy):
        rotation = from_rpy(joint.rpy).T @ rotation
    if joint.kind is JointKind.FIXED:
        return position, rotation
    if joint.is_prismatic:
        return position + (np.array(joint.axis) @ rotation) * values, rotation
    return position, _turned(rotation, joint.axis, values)


def _turned(rotation: Floats, axis: tuple[float, float, float], values: Floats) -> Floats:
    """Rotations (3, 3, N) turned about an axis of theirs by values (N,)."""
    sine = np.sin(values)
    if sorted(map(abs, axis)) == [0.0, 0.0, 1.0]:
        # About the axis of one column the two others turn in their plane.
        third = int(np.argmax(np.abs(axis)))
        first, second = (third + 1) % 3, (third + 2) % 3
        sine, cosine = sine * axis[third], np.cos(values)
        found = np.empty(np.broadcast_shapes(rotation.shape, values.shape))
        found[:, third] = rotation[:, third]
        found[:, first] = cosine * rotation[:, first] + sine * rotation[:, second]
        found[:, second] = cosine * rotation[:, second] - sine * rotation[:, first]
        return found
    k = cross_matrix(np.array(axis)).T
    once = k @ rotation
    half = np.sin(0.5 * values)
    return np.asarray(rotation + sine * once + 2.0 * half * half * (k @ once))


def rows_first(pose: RowsLast, rows: int = 1) -> tuple[Floats, Floats]:
    """Positions (N, 3) m and rotations (N, 3, 3); `rows` of them where one pose stands for all."""
    position, rotation = pose
    rows = max(rows, position.shape[1], rotation.shape[2])
    at, turned = np.empty((rows, 3)), np.empty((rows, 3, 3))
    at.T[:], turned.transpose(1, 2, 0)[:] = position, rotation
    return at, turned
