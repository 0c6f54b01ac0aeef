"""SRDF text -> pairs of links whose contact means nothing."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Collection

from irlx.robot.urdf_values import RobotModelError

LinkPairs = frozenset[frozenset[str]]


def pairs_that_may_touch(text: str, links: Collection[str]) -> LinkPairs:
    """Pairs of `links` that an SRDF takes out of collision checking.

    <disable_collisions> names a pair, <disable_default_collisions> a link with all others,
    <enable_collisions> takes a pair back. Links that are not among `links` are passed over: an SRDF may
    be for a robot with more tools. Raises RobotModelError for a text that is no SRDF.
    """
    try:
        root = ET.fromstring(text)
    except ET.ParseError as cause:
        raise RobotModelError(f"it is not well-formed XML: {cause}") from cause
    if root.tag != "robot":
        raise RobotModelError(f"its outermost element is <{root.tag}>, an SRDF has <robot>", root.tag)
    disabled = _pairs(root, "disable_collisions")
    for element in root.findall("disable_default_collisions"):
        link = element.get("link", "")
        disabled |= {frozenset((link, other)) for other in links}
    disabled -= _pairs(root, "enable_collisions")
    known = frozenset(links)
    return frozenset(pair for pair in disabled if len(pair) == 2 and pair <= known)


def _pairs(root: ET.Element, tag: str) -> set[frozenset[str]]:
    return {frozenset((element.get("link1", ""), element.get("link2", ""))) for element in root.findall(tag)}
