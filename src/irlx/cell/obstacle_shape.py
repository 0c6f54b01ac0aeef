"""The shape of an `[[obstacle]]`: which sizes go with it, mm -> m, and mesh files."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from irlx.cell.find import is_file
from irlx.cell.findings import Findings
from irlx.cell.schema import ObstacleSection
from irlx.diagnostics.diagnostic import near_matches
from irlx.diagnostics.near_files import near_files
from irlx.solids.mesh_file import MeshFileError, MeshReaderMissing, read_closed_mesh
from irlx.solids.shape import Box, Capsule, Cone, Cylinder, Halfspace, Mesh, Point, Shape, Sphere

SIZES: dict[str, tuple[str, ...]] = {
    "point": (),
    "sphere": ("radius",),
    "box": ("size",),
    "cylinder": ("radius", "length"),
    "capsule": ("radius", "length"),
    "cone": ("radius", "length"),
    "halfspace": (),
    "mesh": ("file",),
    "group": ("members",),
}
"""Shapes that an obstacle may have, and the keys that each needs."""
_OPTIONAL = {"mesh": ("scale",)}
_EVERYWHERE = ("frame", "xyz", "rpy", "trajectory", "margin", "influence")
_OF_SHAPES = ("size", "radius", "length", "file", "scale", "members")
INSTALL_MESHES = 'pip install "irlx[meshes]"'
_SMALL, _LARGE = 1e-3, 100.0
"""Extents (m) outside of which a mesh has more likely the wrong unit."""


def sizes_fit(section: ObstacleSection, findings: Findings) -> bool:
    """Whether a table's shape is known and has the keys that it needs; else IRL630 to IRL632 tell."""
    needed = SIZES.get(section.shape)
    if needed is None:
        near = near_matches(section.shape, tuple(SIZES))
        findings.error("IRL630", "shape", shape=section.shape, near=near, known=", ".join(SIZES))
        return False
    missing = [key for key in needed if not getattr(section, key)]
    if missing:
        findings.error("IRL631", shape=section.shape, missing=" and ".join(missing))
    extra = [key for key in sorted(section.model_fields_set) if not _goes_with(key, section)]
    takes = (*needed, *_OPTIONAL.get(section.shape, ()))
    takes = takes if section.shape == "group" else (*takes, *_EVERYWHERE)
    for key in extra:
        with_path = section.shape != "group" and key in ("xyz", "rpy")
        what = "an obstacle with trajectory" if with_path else f"a {section.shape}"
        findings.error("IRL632", key, what=what, extra=key, takes=", ".join(takes))
    return not missing and not extra


def _goes_with(key: str, section: ObstacleSection) -> bool:
    if key in ("name", "shape"):
        return True
    if section.shape == "group":
        return key == "members"
    if key in _OF_SHAPES:
        return key in SIZES[section.shape] or key in _OPTIONAL.get(section.shape, ())
    return not (section.trajectory and key in ("xyz", "rpy"))


def solid_shape(section: ObstacleSection, folder: Path, findings: Findings) -> Shape | None:
    """Shape of an obstacle whose sizes fit, m; None for a mesh that cannot be used, which `findings` tells.

    Mesh files are looked for from `folder`, the cell's own.
    """
    radius, length = (section.radius or 0.0) * 1e-3, (section.length or 0.0) * 1e-3
    match section.shape:
        case "point":
            return Point()
        case "sphere":
            return Sphere(radius)
        case "box":
            x, y, z = (edge * 1e-3 for edge in section.size or ())
            return Box((x, y, z))
        case "cylinder":
            return Cylinder(radius, length)
        case "capsule":
            return Capsule(radius, length)
        case "cone":
            return Cone(radius, length)
        case "halfspace":
            return Halfspace()
    return _mesh(section, folder, findings)


def _mesh(section: ObstacleSection, folder: Path, findings: Findings) -> Mesh | None:
    path = folder / (section.file or "")
    if not is_file(path):
        findings.error("IRL639", "file", file=section.file, tried=path, near=near_files(path))
        return None
    mesh = Mesh(str(path.absolute()), section.scale)
    try:
        extent = float(np.max(np.ptp(read_closed_mesh(mesh).vertices, axis=0)))
    except MeshReaderMissing as cause:
        findings.error("IRL641", "file", file=section.file, cause=cause.reason, command=INSTALL_MESHES)
        return None
    except MeshFileError as cause:
        findings.error("IRL640", "file", file=section.file, cause=cause.reason)
        return None
    if not _SMALL <= extent <= _LARGE:
        findings.warning("IRL642", "file", file=section.file, extent=f"{extent * 1e3:.3g}")
    return mesh
