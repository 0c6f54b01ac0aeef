"""URDF text -> `RobotDescription`; what links look like is left to those who draw."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from math import inf, sqrt

from irlx.robot.description import Inertial, Joint, JointKind, Mimic, RobotDescription
from irlx.robot.link_solids import link_solids
from irlx.robot.urdf_values import RobotModelError, number_of, origin_of, vector_of
from irlx.solids.placement import Vector3
from irlx.solids.shape import Solid

MOST_LINKS = 500
"""Links of a robot; longer chains are a mistake, and would exhaust the stack."""


def read_urdf(
    text: str,
    tip: str | None = None,
    locked: Mapping[str, float] | None = None,
    carriers: Collection[str] = (),
) -> RobotDescription:
    """Description of the robot in a URDF text.

    `tip` is the link that moves address, by default the only leaf of the tree; `locked` maps joint
    names to the values (rad or m) they are held at; joints that lead to the links `carriers` are axes as
    well. Raises RobotModelError naming the element.
    """
    model = _model(text)
    links, joints = model.links, model.joints
    root = _check_tree(links, joints)
    tip = _choose_tip(tip, links, joints)
    locked = dict(locked or {})
    for name in locked:
        if name not in {joint.name for joint in joints}:
            known = tuple(joint.name for joint in joints)
            raise RobotModelError(f"no joint is called '{name}'", name, known)
    for link in carriers:
        if link not in links:
            raise RobotModelError(f"no link is called '{link}'", link, tuple(links))
    inertials, solids = dict(model.inertials), dict(model.solids)
    robot = RobotDescription(
        model.name, root, tip, joints, inertials, locked, solids=solids, carriers=tuple(carriers)
    )
    check_followers(robot)
    return _within_followers(robot)


@dataclass(frozen=True)
class _Model:
    """What a URDF text says, whatever the tip."""

    name: str
    links: tuple[str, ...]
    joints: tuple[Joint, ...]
    inertials: Mapping[str, Inertial]
    solids: Mapping[str, tuple[Solid, ...]]


@lru_cache(maxsize=8)
def _model(text: str) -> _Model:
    """Content of a URDF text; loading a cell asks for it several times, and so do runs in one process."""
    root = _robot_element(text)
    joints = tuple(_joint(element) for element in root.findall("joint"))
    elements = root.findall("link")
    inertials = {
        element.get("name", ""): inertial
        for element in elements
        if (inertial := _inertial(element)) is not None
    }
    links = tuple(element.get("name", "") for element in elements)
    return _Model(root.get("name", "robot"), links, joints, inertials, link_solids(elements))


def _robot_element(text: str) -> ET.Element:
    try:
        element = ET.fromstring(text)
    except ET.ParseError as cause:
        raise RobotModelError(f"it is not well-formed XML: {cause}") from cause
    if element.tag != "robot":
        raise RobotModelError(f"its outermost element is <{element.tag}>, a URDF has <robot>", element.tag)
    return element


def check_followers(robot: RobotDescription) -> None:
    """Raise RobotModelError where a joint that moves the tool follows one that is no axis of the robot.

    Joints that follow others are nobody's business where they are held or lie off the chain.
    """
    by_name, moving = {joint.name: joint for joint in robot.joints}, {joint.name for joint in robot.moving}
    for follower in robot.moving:
        joint, passed = follower, {follower.name}
        while joint.mimic is not None:
            leader = joint.mimic.leader
            if leader in passed:
                raise RobotModelError(f"joint '{follower.name}' follows itself", follower.name)
            if leader not in moving:
                raise RobotModelError(_no_leader(robot, joint, by_name), joint.name)
            joint = by_name[leader]
            passed.add(leader)


def _no_leader(robot: RobotDescription, joint: Joint, by_name: Mapping[str, Joint]) -> str:
    """Why a joint cannot follow the one that it mimics."""
    assert joint.mimic is not None
    name = joint.mimic.leader
    if name not in by_name:
        why = "which does not exist"
    elif name in robot.locked:
        why = "which is locked"
    elif by_name[name].kind is JointKind.FIXED:
        why = "which is fixed"
    else:
        why = "which does not move the tool"
    return f"joint '{joint.name}' moves the tool and mimics '{name}', {why}; lock it"


def _within_followers(robot: RobotDescription) -> RobotDescription:
    """The robot with limits of its axes that keep those of the joints that follow them."""
    narrowed = {joint.name: joint for joint in robot.axes}
    for joint, (axis, multiplier, offset) in zip(robot.moving, robot.coupling, strict=True):
        if joint.mimic is None or multiplier == 0.0:
            continue
        leader = narrowed[robot.axes[axis].name]
        ends = sorted((end - offset) / multiplier for end in (joint.lower, joint.upper))
        lower, upper = max(leader.lower, ends[0]), min(leader.upper, ends[1])
        if lower > upper:
            message = f"joint '{joint.name}' follows '{leader.name}', but no value of that keeps both limits"
            raise RobotModelError(message, joint.name)
        speed = min(leader.speed, joint.speed / abs(multiplier))
        narrowed[leader.name] = replace(leader, lower=lower, upper=upper, speed=speed)
    joints = tuple(narrowed.get(joint.name, joint) for joint in robot.joints)
    return replace(robot, joints=joints) if joints != robot.joints else robot


def _check_tree(links: Sequence[str], joints: tuple[Joint, ...]) -> str:
    """Name of the root link; raises RobotModelError where links and joints form no tree."""
    if not links:
        raise RobotModelError("it has no <link>")
    if len(links) > MOST_LINKS:
        raise RobotModelError(f"it has {len(links)} links; at most {MOST_LINKS} are read")
    for what, names in (("link", links), ("joint", [joint.name for joint in joints])):
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise RobotModelError(f"two {what}s are called '{twice[0]}'", twice[0])
    parent_of: dict[str, str] = {}
    for joint in joints:
        for link in (joint.parent, joint.child):
            if link not in links:
                message = f"joint '{joint.name}' names a link '{link}' that does not exist"
                raise RobotModelError(message, joint.name, tuple(links))
        if joint.child in parent_of:
            raise RobotModelError(f"link '{joint.child}' is the child of two joints", joint.child)
        parent_of[joint.child] = joint.parent
    roots = [link for link in links if link not in parent_of]
    if len(roots) != 1:
        found = ", ".join(roots) if roots else "none (the joints form a ring)"
        raise RobotModelError(f"one link must have no parent; found {found}")
    reached = {roots[0]}
    for _ in links:
        reached |= {joint.child for joint in joints if joint.parent in reached}
    if len(reached) != len(links):
        lost = next(link for link in links if link not in reached)
        raise RobotModelError(f"link '{lost}' hangs in a ring of joints", lost)
    return roots[0]


def _choose_tip(tip: str | None, links: Sequence[str], joints: tuple[Joint, ...]) -> str:
    if tip is not None:
        if tip not in links:
            raise RobotModelError(f"no link is called '{tip}'", tip, tuple(links))
        return tip
    parents = {joint.parent for joint in joints}
    leaves = tuple(link for link in links if link not in parents)
    if len(leaves) != 1:
        message = f"it has {len(leaves)} links at an end ({', '.join(leaves)}); say which one is the tip"
        raise RobotModelError(message, "tip", leaves)
    return leaves[0]


def _joint(element: ET.Element) -> Joint:
    name = element.get("name", "")
    if not name:
        raise RobotModelError("a <joint> has no name")
    kind_text = element.get("type", "")
    try:
        kind = JointKind(kind_text)
    except ValueError:
        known = tuple(kind.value for kind in JointKind)
        message = f"joint '{name}' is of type '{kind_text}'; irlx moves {', '.join(known)}"
        raise RobotModelError(message, name, known) from None
    parent, child = (_link_of(element, tag, name) for tag in ("parent", "child"))
    xyz, rpy = origin_of(element, f"joint '{name}'")
    lower, upper, speed = _joint_limits(element, name, kind)
    axis, mimic = _axis(element, name, kind), _mimic(element, name)
    return Joint(name, kind, parent, child, xyz, rpy, axis, lower, upper, speed, mimic)


def _mimic(element: ET.Element, name: str) -> Mimic | None:
    found = element.find("mimic")
    if found is None:
        return None
    where, leader = f"joint '{name}', mimic", found.get("joint")
    if not leader:
        raise RobotModelError(f"{where}: it names no joint", name)
    multiplier = number_of(found.get("multiplier", "1"), "multiplier", where)
    return Mimic(leader, multiplier, number_of(found.get("offset", "0"), "offset", where))


def _link_of(element: ET.Element, tag: str, name: str) -> str:
    found = element.find(tag)
    link = found.get("link") if found is not None else None
    if not link:
        raise RobotModelError(f"joint '{name}' has no <{tag} link=\"...\">", name)
    return link


def _axis(element: ET.Element, name: str, kind: JointKind) -> Vector3:
    found = element.find("axis")
    if found is None or kind is JointKind.FIXED:
        return (1.0, 0.0, 0.0)
    x, y, z = vector_of(found, "xyz", f"joint '{name}', axis")
    length = sqrt(x * x + y * y + z * z)
    if length < 1e-9:
        raise RobotModelError(f"the axis of joint '{name}' has no direction", name)
    return (x / length, y / length, z / length)


def _joint_limits(element: ET.Element, name: str, kind: JointKind) -> tuple[float, float, float]:
    found = element.find("limit")
    where = f"joint '{name}', limit"

    def value(attribute: str, default: float) -> float:
        word = found.get(attribute) if found is not None else None
        return default if word is None else number_of(word, attribute, where)

    speed = value("velocity", inf)
    if speed < 0.0:
        raise RobotModelError(f"{where}: velocity is negative", name)
    if kind in (JointKind.FIXED, JointKind.CONTINUOUS):
        return -inf, inf, speed
    # A URDF limit without a side counts as 0 by the format, but as "not given" it says more to people.
    lower, upper = value("lower", -inf), value("upper", inf)
    if lower > upper:
        raise RobotModelError(f"{where}: lower {lower} is above upper {upper}", name)
    return lower, upper, speed


def _inertial(element: ET.Element) -> Inertial | None:
    found = element.find("inertial")
    if found is None:
        return None
    where = f"link '{element.get('name', '')}', inertial"
    xyz, rpy = origin_of(found, where)
    mass = found.find("mass")
    inertia = found.find("inertia")
    return Inertial(
        0.0 if mass is None else number_of(mass.get("value", "0"), "mass", where),
        xyz,
        rpy,
        (
            _moment(inertia, "ixx", where),
            _moment(inertia, "ixy", where),
            _moment(inertia, "ixz", where),
            _moment(inertia, "iyy", where),
            _moment(inertia, "iyz", where),
            _moment(inertia, "izz", where),
        ),
    )


def _moment(element: ET.Element | None, attribute: str, where: str) -> float:
    return 0.0 if element is None else number_of(element.get(attribute, "0"), attribute, where)
