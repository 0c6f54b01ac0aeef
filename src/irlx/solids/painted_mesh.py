"""Mesh files -> surfaces and their colours, for pictures."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from irlx.solids.colour import Colour
from irlx.solids.mesh_file import (
    MeshFileError,
    arrays_of,
    joined,
    read_mesh,
    read_with_trimesh,
    scaled,
    state_of,
)
from irlx.solids.shape import Mesh
from irlx.solids.triangles import Triangles

_WITH_COLOURS = (".dae", ".obj", ".ply")
_KEPT = 256


@dataclass(frozen=True, eq=False)
class PaintedSurface:
    """Triangles of one colour, None where their file gives none."""

    surface: Triangles
    colour: Colour | None = None


def read_painted_mesh(mesh: Mesh) -> tuple[PaintedSurface, ...]:
    """Surfaces in the file of a mesh, one a colour, in m: its vertices times `mesh.scale`.

    What `read_mesh` says of the units, the axes and the vertices holds. Of vertices and pixels with colours
    of their own the mean counts. Raises MeshFileError as `read_mesh` does.
    """
    path = Path(mesh.file)
    if path.suffix.lower() not in _WITH_COLOURS:
        return (PaintedSurface(read_mesh(mesh)),)
    return _read(mesh, *state_of(path))


@lru_cache(maxsize=_KEPT)
def _read(mesh: Mesh, modified: int, size: int) -> tuple[PaintedSurface, ...]:
    """`read_painted_mesh`; time of change (ns) and size tell a file that was written anew."""
    by_colour: dict[Colour | None, list[Any]] = {}
    for part in read_with_trimesh(Path(mesh.file), _parts):
        by_colour.setdefault(_colour(part), []).append(part)
    surfaces = ((_surface(parts, mesh), colour) for colour, parts in by_colour.items())
    found = tuple(PaintedSurface(surface, colour) for surface, colour in surfaces if len(surface.faces))
    if not found:
        raise MeshFileError("it holds no triangles")
    return found


def _parts(path: Path) -> list[Any]:
    """Meshes of a file, each in its place, in m."""
    import trimesh

    scene = trimesh.load_scene(str(path), process=False)
    if path.suffix.lower() == ".dae":
        scene = scene.convert_units("meters")
    return [part for part in scene.dump() if isinstance(part, trimesh.Trimesh)]


def _colour(part: Any) -> Colour | None:
    visual = part.visual
    if not visual.defined:
        return None
    material = getattr(visual, "material", None)
    colour = visual.main_color if material is None else material.main_color
    red, green, blue, opacity = (float(number) / 255.0 for number in colour)
    return Colour(red, green, blue, opacity)


def _surface(parts: list[Any], mesh: Mesh) -> Triangles:
    vertices, faces, before = [], [], 0
    for part in parts:
        points, corners = arrays_of(part)
        vertices.append(points)
        faces.append(corners + before)
        before += len(points)
    return scaled(*joined(np.concatenate(vertices), np.concatenate(faces)), mesh)
