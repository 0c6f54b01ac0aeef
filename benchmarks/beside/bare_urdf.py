"""The URDF that all others get: what irlx reads of it, without the shapes, the fingers held."""

from __future__ import annotations

import xml.etree.ElementTree as ET


def bare_urdf(urdf: str, held: tuple[str, ...]) -> str:
    """A URDF without meshes, joints of `held` fixed where they stand at 0; frames and limits stay."""
    robot = ET.fromstring(urdf)
    for link in robot.findall("link"):
        _without(link, "visual", "collision")
    for joint in robot.findall("joint"):
        _without(joint, "safety_controller", "mimic", "dynamics")
        if joint.get("name") in held:
            joint.set("type", "fixed")
            _without(joint, "limit", "axis")
    return ET.tostring(robot, encoding="unicode")


def _without(element: ET.Element, *tags: str) -> None:
    for tag in tags:
        for found in element.findall(tag):
            element.remove(found)
