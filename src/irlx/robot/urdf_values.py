"""Numbers, vectors and origins of URDF elements."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from math import isfinite

from irlx.solids.placement import Vector3


class RobotModelError(ValueError):
    """A robot model that cannot be used; `subject` names the element, `known` the valid names if any."""

    def __init__(self, message: str, subject: str = "", known: tuple[str, ...] = ()) -> None:
        self.subject = subject
        self.known = known
        super().__init__(message)


def origin_of(element: ET.Element, where: str) -> tuple[Vector3, Vector3]:
    """xyz (m) and rpy (rad) of an element's <origin>, zero where it has none. Raises RobotModelError."""
    origin = element.find("origin")
    if origin is None:
        return (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    return vector_of(origin, "xyz", where), vector_of(origin, "rpy", where)


def vector_of(element: ET.Element, attribute: str, where: str) -> Vector3:
    """Three numbers of an attribute, zero where it is missing. Raises RobotModelError."""
    words = element.get(attribute, "0 0 0").split()
    if len(words) != 3:
        raise RobotModelError(f"{where}: {attribute} needs three numbers, found {len(words)}", where)
    return (
        number_of(words[0], attribute, where),
        number_of(words[1], attribute, where),
        number_of(words[2], attribute, where),
    )


def number_of(word: str, attribute: str, where: str) -> float:
    """A finite number. Raises RobotModelError."""
    try:
        value = float(word)
    except ValueError:
        raise RobotModelError(f"{where}: {attribute} holds '{word}', which is no number", where) from None
    if not isfinite(value):
        raise RobotModelError(f"{where}: {attribute} holds '{word}', which is not finite", where)
    return value
