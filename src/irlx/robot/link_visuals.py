"""<visual> elements of a URDF -> what the links look like.

Kept apart from `RobotDescription`: looks have no part in what a robot does, nor in its fingerprint.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from irlx.robot.link_solids import read_solid
from irlx.robot.urdf_values import RobotModelError, number_of
from irlx.solids.colour import Colour
from irlx.solids.shape import Solid


@dataclass(frozen=True)
class Visual:
    """A solid that is seen, in the link's frame; `colour` None where the model gives none.

    Of a mesh that may hold colours of its own, which count then. Textures are not read.
    """

    solid: Solid
    colour: Colour | None = None


@dataclass(frozen=True)
class LinkVisuals:
    """Visuals by link, of every link that has any; names of mesh files as the URDF has them.

    `faults` tells, link and reason, what of the model cannot be drawn: such links have no visuals here.
    """

    by_link: Mapping[str, tuple[Visual, ...]]
    faults: tuple[tuple[str, str], ...] = ()


def link_visuals(text: str) -> LinkVisuals:
    """What the links in a URDF text, one that `read_urdf` takes, look like.

    Materials count that a visual holds itself, or that it names and the robot or another visual defines.
    """
    root = ET.fromstring(text)
    links = root.findall("link")
    materials = _materials([root, *(visual for link in links for visual in link.findall("visual"))])
    found: dict[str, tuple[Visual, ...]] = {}
    faults: list[tuple[str, str]] = []
    for link in links:
        name = link.get("name", "")
        try:
            visuals = tuple(_visual(element, name, materials) for element in link.findall("visual"))
        except RobotModelError as cause:
            faults.append((name, str(cause)))
            continue
        if visuals:
            found[name] = visuals
    return LinkVisuals(found, tuple(faults))


def _visual(element: ET.Element, link: str, materials: Mapping[str, Colour]) -> Visual:
    material = element.find("material")
    colour = None
    if material is not None:
        colour = _colour(material) or materials.get(material.get("name", ""))
    return Visual(read_solid(element, link), colour)


def _materials(holders: Iterable[ET.Element]) -> dict[str, Colour]:
    """Colours by the names of the materials in some elements; the first of a name counts."""
    found: dict[str, Colour] = {}
    for holder in holders:
        for material in holder.findall("material"):
            colour, name = _colour(material), material.get("name", "")
            if colour is not None and name:
                found.setdefault(name, colour)
    return found


def _colour(material: ET.Element) -> Colour | None:
    """Colour of a material; None where it has none, or none that can be read: it is no reason to fail."""
    element = material.find("color")
    words = [] if element is None else element.get("rgba", "").split()
    try:
        numbers = [min(max(number_of(word, "rgba", "material"), 0.0), 1.0) for word in words]
    except RobotModelError:
        return None
    return Colour(*numbers) if len(numbers) in (3, 4) else None
