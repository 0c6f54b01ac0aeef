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
    solid = {link for link, own in robot.solids.items() if own}
    inwards = {link: _inwards(origin, link) for link in _outwards(robot) if link in solid}
    found = []
    for first, second in combinations(inwards, 2):
        joints = _way(inwards[first], inwards[second])
        between = {link for joint in joints for link in (joint.parent, joint.child)} - {first, second}
        if not axes.isdisjoint(joint.name for joint in joints) and not solid.isdisjoint(between):
            found.append((first, second))
    return tuple(found)


def _outwards(robot: RobotDescription) -> list[str]:
    """All links, parents before their children."""
    found = [robot.root]
    for link in found:
        found += [joint.child for joint in robot.joints if joint.parent == link]
    return found


def _way(up: list[Joint], down: list[Joint]) -> list[Joint]:
    """Joints on the way between two links of the tree, of those from each of them inwards."""
    shared = 0
    while shared < min(len(up), len(down)) and up[~shared] is down[~shared]:
        shared += 1
    return up[: len(up) - shared] + down[: len(down) - shared]


def _inwards(origin: dict[str, Joint], link: str) -> list[Joint]:
    joints = []
    while link in origin:
        joints.append(origin[link])
        link = origin[link].parent
    return joints
