"""Shapes of links and obstacles as nodes of the scene."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from irlx.report.appearance.model import DrawnShape, Part
from irlx.solids.placement import Placement
from irlx.solids.shape import Box, Capsule, Cone, Cylinder, Halfspace, Point, Sphere
from irlx.solids.triangles import Triangles

if TYPE_CHECKING:
    from viser import SceneApi

Colour = tuple[int, int, int]
_POINT = 0.01
"""Radius of the ball that stands for a point, m."""
_PLANE = 20.0
"""Edge of the square that stands for a half-space, m."""


class Look(NamedTuple):
    """How parts are drawn that say nothing themselves: colour, how opaque (1: not to be seen through)."""

    colour: Colour
    opacity: float = 1.0


def wxyz(placement: Placement) -> tuple[float, float, float, float]:
    """Its turn with the scalar first."""
    x, y, z, w = placement.orientation
    return w, x, y, z


def add_part(scene: SceneApi, name: str, part: Part, look: Look) -> Any:
    """The node `name` that shows a part; its pose is that of the part in the frame of the node above it."""
    colour, opacity = look.colour, look.opacity
    if part.colour is not None:
        colour = _rgb(part.colour.red, part.colour.green, part.colour.blue)
        opacity *= part.colour.opacity
    given: dict[str, Any] = {
        "color": colour,
        "opacity": None if opacity >= 1.0 else opacity,
        "wxyz": wxyz(part.placement),
        "position": part.placement.position,
    }
    match part.shape:
        case Box(size):
            return scene.add_box(name, dimensions=size, **given)
        case Sphere(radius):
            return scene.add_icosphere(name, radius=radius, subdivisions=4, **given)
        case Point():
            return scene.add_icosphere(name, radius=_POINT, **given)
    vertices, faces = _surface(part.shape)
    smooth = isinstance(part.shape, Capsule)
    return scene.add_mesh_simple(name, vertices, faces, flat_shading=not smooth, side="double", **given)


def _rgb(*parts: float) -> Colour:
    red, green, blue = (round(255 * part) for part in parts)
    return red, green, blue


def _surface(shape: DrawnShape) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices (V, 3) m and faces (F, 3) of a shape that is no box, ball or point; its axis along z."""
    if isinstance(shape, Triangles):
        return shape.vertices, shape.faces
    if isinstance(shape, Halfspace):
        edge = 0.5 * _PLANE
        corners = [(-edge, -edge, 0.0), (edge, -edge, 0.0), (edge, edge, 0.0), (-edge, edge, 0.0)]
        return np.array(corners), np.array([(0, 1, 2), (0, 2, 3)])
    from trimesh import creation

    match shape:
        case Cylinder(radius, length):
            made = creation.cylinder(radius, length, sections=48)
        case Capsule(radius, length):
            made = creation.capsule(length, radius, count=[32, 32])
            made.apply_translation(-made.bounds.mean(axis=0))
        case Cone(radius, length):
            made = creation.cone(radius, length, sections=48)
            made.apply_translation((0.0, 0.0, -0.5 * length))
        case _:
            raise TypeError(f"no surface of {shape!r}")
    return np.asarray(made.vertices), np.asarray(made.faces)
