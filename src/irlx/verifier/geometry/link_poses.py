"""Poses of all links by the verifier's own forward kinematics."""

from __future__ import annotations

from collections.abc import Collection

from irlx.robot.description import RobotDescription
from irlx.streams.joint_stream import Floats
from irlx.verifier.geometry.forward import ROOT, RowsLast, after_joint, held_at, rows_first, values_of

Poses = tuple[Floats, Floats]
"""Positions (N, 3) m and rotations (N, 3, 3), or (1, 3) and (1, 3, 3) of what rests."""


def link_poses(robot: RobotDescription, q: Floats, links: Collection[str]) -> dict[str, Poses]:
    """Poses of `links` in the root frame for joint values q (N, n); of those that rest one for all rows.

    Joints off the chain to the tip stand at their locked value or at zero.
    """
    told = values_of(robot, q)
    parents = {joint.child: joint for joint in robot.joints}
    found: dict[str, RowsLast] = {robot.root: ROOT}

    def pose(link: str) -> RowsLast:
        if link not in found:
            joint = parents[link]
            found[link] = after_joint(joint, told.get(joint.name, held_at(robot, joint)), pose(joint.parent))
        return found[link]

    return {link: rows_first(pose(link)) for link in links}


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
