"""Poses of all links by the verifier's own forward kinematics."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from irlx.robot.description import JointKind, RobotDescription
from irlx.streams.joint_stream import Floats
from irlx.verifier.geometry.forward import after_joint, values_of

Poses = tuple[Floats, Floats]
"""Positions (N, 3) m and rotations (N, 3, 3), or (1, 3) and (1, 3, 3) of what rests."""


def link_poses(robot: RobotDescription, q: Floats, links: Collection[str]) -> dict[str, Poses]:
    """Poses of `links` in the root frame for joint values q (N, n); of those that rest one for all rows.

    Joints off the chain to the tip stand at their locked value or at zero.
    """
    told = values_of(robot, q)
    parents = {joint.child: joint for joint in robot.joints}
    found: dict[str, Poses] = {robot.root: (np.zeros((1, 3)), np.eye(3)[None])}

    def pose(link: str) -> Poses:
        if link not in found:
            joint = parents[link]
            position, rotation = pose(joint.parent)
            moves = joint.name in told
            values = told[joint.name] if moves else np.array([robot.locked.get(joint.name, 0.0)])
            if joint.kind is JointKind.FIXED:
                values = np.zeros(1)
            if moves and len(position) == 1 and len(values) != 1:
                position = np.repeat(position, len(values), axis=0)
                rotation = np.repeat(rotation, len(values), axis=0)
            elif not moves:
                values = np.repeat(values, len(position))
            found[link] = after_joint(joint, values, position, rotation)
        return found[link]

    return {link: pose(link) for link in links}


def moved_links(robot: RobotDescription) -> frozenset[str]:
    """Names of the links that any axis moves."""
    axes = {joint.name for joint in robot.moving}
    children: dict[str, list[tuple[str, bool]]] = {}
    for joint in robot.joints:
        children.setdefault(joint.parent, []).append((joint.child, joint.name in axes))
    found, waiting = set(), [(robot.root, False)]
    while waiting:
        link, moved = waiting.pop()
        if moved:
            found.add(link)
        waiting += [(child, moved or moves) for child, moves in children.get(link, ())]
    return frozenset(found)
