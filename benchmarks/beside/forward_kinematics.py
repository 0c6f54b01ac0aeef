"""Poses of a chain from its URDF by products of plain matrices: no library that is measured takes part."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Link:
    """A joint and the link behind it: pose of the joint (4, 4) in the link before, axis (3,), kind, bounds.

    `kind` is that of the URDF; `bounds`: lower, upper (rad or m) and speed (per s), infinite where none is
    given.
    """

    name: str
    origin: Array
    axis: Array
    kind: str
    bounds: tuple[float, float, float]

    def poses(self, values: Array) -> Array:
        """Pose (N, 4, 4) of the link in the link before, for values (N,) of the joint."""
        moved = np.tile(np.eye(4), (len(values), 1, 1))
        if self.kind == "prismatic":
            moved[:, :3, 3] = values[:, None] * self.axis
        elif self.kind != "fixed":
            moved[:, :3, :3] = turned(self.axis, values)
        return self.origin @ moved


class Chain:
    """Links from the root of a URDF to `tip`; `moving` are those with a joint that moves, in their order."""

    def __init__(self, urdf: str, tip: str, held: tuple[str, ...] = ()) -> None:
        """Read the text of a URDF; joints in `held` stand at 0 and are no joints of the chain."""
        above = {_named(joint, "child"): joint for joint in ET.fromstring(urdf).iter("joint")}
        links: list[Link] = []
        while tip in above:
            links.append(_link(above[tip], held))
            tip = _named(above[tip], "parent")
        self._links = links[::-1]
        self.moving = [link for link in self._links if link.kind != "fixed"]

    def poses(self, q: Array) -> tuple[Array, Array]:
        """Rotation (N, 3, 3) and position (N, 3), m, of the tip in the root, for postures q (N, n)."""
        pose = np.tile(np.eye(4), (len(q), 1, 1))
        number = 0
        for link in self._links:
            values = np.zeros(len(q))
            if link.kind != "fixed":
                values = q[:, number]
                number += 1
            pose = pose @ link.poses(values)
        return pose[:, :3, :3], pose[:, :3, 3]

    @property
    def limits(self) -> tuple[Array, Array, Array]:
        """Lower and upper bounds (n,), rad or m, and largest speeds (n,) per s."""
        lower, upper, speed = np.array([link.bounds for link in self.moving]).T
        return lower, upper, speed


def turned(axis: Array, angles: Array) -> Array:
    """Rotations (N, 3, 3) about a unit axis by angles (N,), rad: Rodrigues, I + sin K + (1 - cos) K^2."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    sine, cosine = np.sin(angles)[:, None, None], np.cos(angles)[:, None, None]
    rotations: Array = np.eye(3) + sine * cross + (1.0 - cosine) * (cross @ cross)
    return rotations


def _named(joint: ET.Element, tag: str) -> str:
    found = joint.find(tag)
    return "" if found is None else found.get("link", "")


def _numbers(element: ET.Element | None, attribute: str, default: str) -> Array:
    text = default if element is None else element.get(attribute, default)
    return np.array([float(word) for word in text.split()])


def _link(joint: ET.Element, held: tuple[str, ...]) -> Link:
    origin = np.eye(4)
    place = joint.find("origin")
    roll, pitch, yaw = _numbers(place, "rpy", "0 0 0")
    about = zip(np.eye(3)[::-1], (yaw, pitch, roll), strict=True)
    for axis, angle in about:
        origin[:3, :3] = origin[:3, :3] @ turned(axis, np.array([angle]))[0]
    origin[:3, 3] = _numbers(place, "xyz", "0 0 0")
    axis = _numbers(joint.find("axis"), "xyz", "1 0 0")
    limit = joint.find("limit")
    lower, upper, speed = (_numbers(limit, *given)[0] for given in _LIMITS)
    name = joint.get("name", "")
    kind = "fixed" if name in held else joint.get("type", "fixed")
    return Link(name, origin, axis / np.linalg.norm(axis), kind, (lower, upper, speed))


_LIMITS = (("lower", "-inf"), ("upper", "inf"), ("velocity", "inf"))
