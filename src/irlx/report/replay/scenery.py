"""The looks of a cell as data of a page."""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from irlx.cell.cell import Cell
from irlx.report.appearance.model import CellAppearance, DrawnLink, DrawnObstacle, Part
from irlx.solids.placement import Placement
from irlx.solids.shape import Box, Capsule, Cone, Cylinder, Halfspace, Point, Sphere
from irlx.solids.triangles import Triangles

Plain = dict[str, Any]
_FEW_VERTICES = 1 << 16


class Scenery:
    """Makes plain data of the looks of a cell; every surface of triangles is told once, in `meshes`."""

    def __init__(self) -> None:
        self.meshes: list[Plain] = []
        self._numbers: dict[int, int] = {}

    def plain(self, looks: CellAppearance, cell: Cell) -> Plain:
        """`robot`, `obstacles`, `meshes` and `places` of a page."""
        robot = looks.robot
        links = [self._link(link) for link in robot.links]
        obstacles = [self._obstacle(one) for one in looks.obstacles]
        names = {link.name: number for number, link in enumerate(robot.links)}
        return {
            "robot": {"name": robot.name, "tip": robot.tip, "links": links},
            "obstacles": obstacles,
            "meshes": self.meshes,
            "places": places(cell, names),
        }

    def _link(self, link: DrawnLink) -> Plain:
        plain: Plain = {"name": link.name, "parent": -1 if link.parent is None else link.parent}
        joint = link.joint
        if joint is not None:
            plain["joint"] = {
                "name": joint.name,
                "kind": joint.kind,
                **_pose(joint.placement),
                "axis": joint.axis,
                "of": joint.axis_number,
                "multiplier": joint.multiplier,
                "offset": joint.offset,
            }
        return {**plain, "shapes": self._shapes(link.parts)}

    def _obstacle(self, drawn: DrawnObstacle) -> Plain:
        one = drawn.obstacle
        way = [{"time": point.time, **_pose(point.placement)} for point in one.trajectory]
        plain = {"name": one.name, "margin": one.margin, "influence": one.influence, **_pose(one.placement)}
        return {**plain, "trajectory": way, "shapes": self._shapes(drawn.parts)}

    def _shapes(self, parts: Sequence[Part]) -> list[Plain]:
        found = []
        for part in parts:
            colour = part.colour
            look: Plain = {"color": None, "opacity": 1.0}
            if colour is not None:
                look = {"color": colour.code, "opacity": round(colour.opacity, 3)}
            found.append({**self._shape(part), **_pose(part.placement), **look})
        return found

    def _shape(self, part: Part) -> Plain:
        shape = part.shape
        match shape:
            case Triangles():
                return {"kind": "mesh", "mesh": self._mesh(shape)}
            case Box():
                return {"kind": "box", "size": shape.size}
            case Sphere():
                return {"kind": "sphere", "radius": shape.radius}
            case Cylinder() | Capsule() | Cone():
                kind = type(shape).__name__.lower()
                return {"kind": kind, "radius": shape.radius, "length": shape.length}
            case Halfspace() | Point():
                return {"kind": type(shape).__name__.lower()}

    def _mesh(self, surface: Triangles) -> int:
        number = self._numbers.get(id(surface))
        if number is None:
            number = self._numbers[id(surface)] = len(self.meshes)
            few = len(surface.vertices) < _FEW_VERTICES
            self.meshes.append(
                {
                    "vertices": _base64(surface.vertices.astype("<f4")),
                    "faces": _base64(surface.faces.astype("<u2" if few else "<u4")),
                    "index": "u16" if few else "u32",
                }
            )
        return number


def places(cell: Cell, links: Mapping[str, int]) -> list[Plain]:
    """Named frames of a cell, those that move with a link with its number."""
    found: list[Plain] = []
    for name, frame in cell.frames.items():
        w, x, y, z = frame.quaternion
        found.append({"name": name, "xyz": [c * 1e-3 for c in frame.position], "quat": (x, y, z, w)})
    for name, moving in cell.link_frames.items():
        own = {"name": name, "xyz": moving.position, "quat": moving.orientation}
        found.append({**own, "link": links[moving.link]})
    return found


def _pose(placement: Placement) -> Plain:
    return {"xyz": placement.position, "quat": placement.orientation}


def _base64(array: np.ndarray[Any, Any]) -> str:
    return base64.b64encode(np.ascontiguousarray(array).tobytes()).decode("ascii")
