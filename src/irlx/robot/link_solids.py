"""<collision> elements of a URDF -> solids of the links."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable

from irlx.robot.urdf_values import RobotModelError, number_of, origin_of, vector_of
from irlx.solids.placement import Placement
from irlx.solids.shape import Box, Capsule, Cylinder, Mesh, Shape, Solid, Sphere

_KNOWN = ("box", "sphere", "cylinder", "capsule", "mesh")


def link_solids(links: Iterable[ET.Element]) -> dict[str, tuple[Solid, ...]]:
    """Solids of every link that has any, in the link's frame; names of mesh files as the URDF has them.

    Raises RobotModelError for a shape without its sizes, or of a kind that is not known.
    """
    found = {}
    for link in links:
        name = link.get("name", "")
        solids = tuple(read_solid(element, name) for element in link.findall("collision"))
        if solids:
            found[name] = solids
    return found


def read_solid(element: ET.Element, link: str) -> Solid:
    """Solid of a <collision> or a <visual> element of a link. Raises RobotModelError."""
    where = f"link '{link}', {element.tag}"
    geometry = element.find("geometry")
    shapes = list(geometry) if geometry is not None else []
    if len(shapes) != 1:
        raise RobotModelError(f"{where}: it needs one shape, found {len(shapes)}", link)
    return Solid(_shape(shapes[0], where), Placement.from_rpy(*origin_of(element, where)))


def _shape(element: ET.Element, where: str) -> Shape:
    where = f"{where}, {element.tag}"
    match element.tag:
        case "box":
            x, y, z = (_length(value, "size", where) for value in vector_of(element, "size", where))
            return Box((x, y, z))
        case "sphere":
            return Sphere(_size(element, "radius", where))
        case "cylinder":
            return Cylinder(_size(element, "radius", where), _size(element, "length", where))
        case "capsule":
            return Capsule(_size(element, "radius", where), _size(element, "length", where))
        case "mesh":
            file = element.get("filename", "")
            if not file:
                raise RobotModelError(f"{where}: it names no file", where)
            scale = (1.0, 1.0, 1.0)
            return Mesh(file, vector_of(element, "scale", where) if element.get("scale") else scale)
    raise RobotModelError(f"{where}: this shape is not known", where, _KNOWN)


def _size(element: ET.Element, attribute: str, where: str) -> float:
    return _length(number_of(element.get(attribute, "0"), attribute, where), attribute, where)


def _length(value: float, attribute: str, where: str) -> float:
    if not value > 0.0:
        raise RobotModelError(f"{where}: {attribute} {value:g} is not above 0", where)
    return value
