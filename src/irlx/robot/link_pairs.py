"""Pairs of links that a motion could bring into contact."""

from __future__ import annotations

from itertools import combinations

from irlx.robot.description import Joint, RobotDescription


def pairs_that_could_meet(robot: RobotDescription) -> tuple[tuple[str, str], ...]:
    """Pairs of links with solids between which an axis moves and that are not neighbours.

    Neighbours are links whose way through the tree passes no third link with solids: what joins them may
    always touch. Both orders of the tree: pairs and the links in them go from the root outwards.
    """
    origin = {joint.child: joint for joint in robot.joints}
    axes = {joint.name for joint in robot.moving}
    links = [link for link in _outwards(robot) if robot.solids.get(link)]
    found = []
    for first, second in combinations(links, 2):
        joints, between = _way(origin, first, second)
        moved = any(joint.name in axes for joint in joints)
        if moved and any(robot.solids.get(link) for link in between):
            found.append((first, second))
    return tuple(found)


def _outwards(robot: RobotDescription) -> list[str]:
    """All links, parents before their children."""
    found = [robot.root]
    for link in found:
        found += [joint.child for joint in robot.joints if joint.parent == link]
    return found


def _way(origin: dict[str, Joint], first: str, second: str) -> tuple[list[Joint], set[str]]:
    """Joints and links on the way between two links of the tree, the two left out."""
    up, down = _inwards(origin, first), _inwards(origin, second)
    shared = {joint.name for joint in up} & {joint.name for joint in down}
    joints = [joint for joint in up + down if joint.name not in shared]
    links = {link for joint in joints for link in (joint.parent, joint.child)}
    return joints, links - {first, second}


def _inwards(origin: dict[str, Joint], link: str) -> list[Joint]:
    joints = []
    while link in origin:
        joints.append(origin[link])
        link = origin[link].parent
    return joints
