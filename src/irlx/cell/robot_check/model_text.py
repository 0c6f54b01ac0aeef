"""A URDF read leniently: what is there, None for what is missing or cannot be read."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass

from irlx.robot.urdf_values import RobotModelError, number_of, vector_of
from irlx.solids.placement import Vector3

ORIGIN: Vector3 = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class JointText:
    """A joint as it is written: xyz m, lower and upper rad or m, speed per s; None is "not given"."""

    name: str
    kind: str
    parent: str
    child: str
    xyz: Vector3
    axis: Vector3 | None
    lower: float | None
    upper: float | None
    speed: float | None
    mimics: str | None

    @property
    def moves(self) -> bool:
        """Whether it is of a kind that moves."""
        return self.kind in ("revolute", "continuous", "prismatic")

    @property
    def slides(self) -> bool:
        """Whether its values are m and not rad."""
        return self.kind == "prismatic"


@dataclass(frozen=True)
class ShapeText:
    """A collision shape: edges of its bounding box, m, where its numbers tell, or a mesh file."""

    size: Vector3 | None = None
    file: str = ""
    scale: Vector3 = (1.0, 1.0, 1.0)


@dataclass(frozen=True)
class LinkText:
    """A link: mass kg and centre m, None without <inertial>; ixx, ixy, ixz, iyy, iyz, izz kg m2."""

    name: str
    mass: float | None
    centre: Vector3
    inertia: tuple[float, ...] | None
    shapes: tuple[ShapeText, ...]


@dataclass(frozen=True)
class ModelText:
    """Links and joints of a URDF; names may be doubled, missing or lead nowhere."""

    links: tuple[LinkText, ...]
    joints: tuple[JointText, ...]

    @property
    def ends(self) -> tuple[str, ...]:
        """Links without a child."""
        parents = {joint.parent for joint in self.joints}
        return tuple(link.name for link in self.links if link.name not in parents)

    @property
    def root(self) -> str | None:
        """The first link that no joint leads to, None without links or where they all form a ring."""
        children = {joint.child for joint in self.joints}
        return next((link.name for link in self.links if link.name not in children), None)

    def chain(self, tip: str) -> tuple[JointText, ...]:
        """Joints that lead to a link, from the root; where they form a ring, each of them once."""
        into = {joint.child: joint for joint in self.joints}
        found: list[JointText] = []
        while tip in into and into[tip] not in found:
            found.append(into[tip])
            tip = into[tip].parent
        return tuple(reversed(found))


def model_text(text: str) -> ModelText:
    """Links and joints of a text, none where it is no XML."""
    try:
        root = ET.fromstring(text)
    except ET.ParseError:
        return ModelText((), ())
    links = tuple(_link(element) for element in root.findall("link"))
    return ModelText(links, tuple(_joint(element) for element in root.findall("joint")))


def _joint(element: ET.Element) -> JointText:
    limit, axis, mimic = element.find("limit"), element.find("axis"), element.find("mimic")
    return JointText(
        element.get("name", ""),
        element.get("type", ""),
        _attribute(element.find("parent"), "link"),
        _attribute(element.find("child"), "link"),
        _vector(element.find("origin"), "xyz") or ORIGIN,
        None if axis is None else _vector(axis, "xyz"),
        _number(limit, "lower"),
        _number(limit, "upper"),
        _number(limit, "velocity"),
        None if mimic is None else mimic.get("joint", ""),
    )


def _link(element: ET.Element) -> LinkText:
    inertial = element.find("inertial")
    mass: float | None = None
    centre, inertia = ORIGIN, None
    if inertial is not None:
        mass = _number(inertial.find("mass"), "value")
        centre = _vector(inertial.find("origin"), "xyz") or ORIGIN
        inertia = _inertia(inertial.find("inertia"))
    shapes = tuple(_shape(found) for found in element.findall("collision"))
    return LinkText(element.get("name", ""), mass, centre, inertia, shapes)


def _inertia(element: ET.Element | None) -> tuple[float, ...] | None:
    if element is None:
        return None
    moments = (_number(element, name) for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
    return tuple(0.0 if moment is None else moment for moment in moments)


def _shape(collision: ET.Element) -> ShapeText:
    geometry = collision.find("geometry")
    shape = next(iter(geometry), None) if geometry is not None else None
    if shape is None:
        return ShapeText()
    if shape.tag == "mesh":
        return ShapeText(
            None, shape.get("filename", ""), _vector(shape, "scale", missing=None) or ShapeText.scale
        )
    if shape.tag == "box":
        return ShapeText(_vector(shape, "size"))
    radius, length = _number(shape, "radius"), _number(shape, "length")
    if radius is None:
        return ShapeText()
    across, along = 2.0 * radius, length or 0.0
    round_ends = across if shape.tag in ("sphere", "capsule") else 0.0
    return ShapeText((across, across, along + round_ends))


def _attribute(element: ET.Element | None, name: str) -> str:
    return "" if element is None else element.get(name, "")


def _number(element: ET.Element | None, name: str) -> float | None:
    word = None if element is None else element.get(name)
    try:
        return None if word is None else number_of(word, name, "")
    except RobotModelError:
        return None


def _vector(element: ET.Element | None, name: str, missing: Vector3 | None = ORIGIN) -> Vector3 | None:
    """Three numbers of an attribute, `missing` where it is not there, None where it cannot be read."""
    if element is None or element.get(name) is None:
        return missing
    try:
        return vector_of(element, name, "")
    except RobotModelError:
        return None
