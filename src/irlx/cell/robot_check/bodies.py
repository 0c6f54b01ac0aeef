"""Bodies that joints move: mass, inertia, size, and shapes that others must not touch."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import sqrt
from pathlib import Path

import numpy as np

from irlx.cell.link_meshes import find_mesh
from irlx.cell.robot_check.findings import ModelFindings, joint_key, length_of, link_key
from irlx.cell.robot_check.model_text import LinkText, ModelText, ShapeText
from irlx.solids.mesh_file import MeshFileError, read_mesh
from irlx.solids.placement import Vector3
from irlx.solids.shape import Mesh

_FAR = 50.0
_LARGEST, _SMALLEST = 100.0, 1e-3
"""Extents, m, beyond which numbers of a mesh file are likely to have another unit, as in a cell (IRL642)."""

_HOLLOW, _DENSE = 1.0, 0.01
"""Radius of gyration over the diagonal of the box about a link: at most 0.5 for whatever lies in the box."""

_ROUNDING = 1e-6


def check_bodies(model: ModelText, axes: Sequence[str], folder: Path, findings: ModelFindings) -> None:
    """Findings on everything that the joints `axes` move: IRL654, IRL656, IRL657, IRL660 to IRL662, IRL667.

    Mesh files are named from `folder`, that of the URDF.
    """
    bodies = _bodies(model, axes)
    sizes = _sizes(model, folder, [link for links in bodies.values() for link in links], findings)
    bare = []
    for joint, links in bodies.items():
        if not any(link.mass for link in links):
            cause = f"nothing between it and the next joint has a mass (links {_names(links)})"
            findings.tell("IRL654", joint_key(joint), what=joint, cause=cause)
        several = sum(any(link.inertia or ()) for link in links) > 0
        for link in links:
            # Frames of sensors and tools on a link are often points of little mass.
            if not several or any(link.inertia or ()) or (link.mass or 0.0) < 0.0:
                _check_inertial(link, sizes.get(link.name), findings)
        if not any(link.shapes for link in links):
            bare.append(joint)
    if bare:
        which = "any joint" if len(bare) == len(bodies) else " or ".join(bare)
        findings.tell("IRL667", which=which)


def _bodies(model: ModelText, axes: Sequence[str]) -> Mapping[str, list[LinkText]]:
    """Links that each axis moves and no axis behind it: the body that it carries."""
    carried_by: dict[str, str] = {}
    bodies: dict[str, list[LinkText]] = {name: [] for name in axes}
    links = {link.name: link for link in model.links}
    waiting = [joint for joint in model.joints if joint.name in bodies]
    starts = {joint.child: joint.name for joint in waiting}
    for link in model.links:
        at, passed = link.name, {link.name}
        into = {joint.child: joint.parent for joint in model.joints}
        while at not in starts and at in into and into[at] not in passed:
            at = into[at]
            passed.add(at)
        if at in starts:
            carried_by[link.name] = starts[at]
    for name, joint_name in carried_by.items():
        bodies[joint_name].append(links[name])
    return bodies


def _names(links: Sequence[LinkText]) -> str:
    return ", ".join(link.name for link in links) or "none"


def _check_inertial(link: LinkText, size: float | None, findings: ModelFindings) -> None:
    key = link_key(link.name)
    if length_of(link.centre) > _FAR:
        what = f"the centre of mass of '{link.name}' lies"
        findings.tell("IRL660", key, what=what, found=f"{length_of(link.centre):.6g} m from its frame")
    if link.mass is None:
        return
    if link.mass < 0.0 or (link.mass == 0.0 and any(link.inertia or ())):
        cause = f"its mass is {link.mass:g} kg"
        findings.tell("IRL654", key, what=f"'{link.name}'", cause=cause)
        return
    if link.mass == 0.0:
        return
    moments = _moments(link.inertia)
    cause = _no_body(moments)
    if cause:
        findings.tell("IRL656", key, link=link.name, cause=cause)
    elif size and size <= _FAR:  # Beyond, it is the size that has another unit.
        gyration = sqrt(moments[2] / link.mass)
        word = "large" if gyration > _HOLLOW * size else "small" if gyration < _DENSE * size else ""
        if word:
            data = {"gyration": f"{gyration * 1e3:.4g}", "size": f"{size * 1e3:.4g}"}
            findings.tell("IRL657", key, link=link.name, word=word, mass=f"{link.mass:g}", **data)


def _moments(inertia: tuple[float, ...] | None) -> tuple[float, float, float]:
    """Principal moments of inertia, kg m2, the largest last."""
    if inertia is None:
        return 0.0, 0.0, 0.0
    ixx, ixy, ixz, iyy, iyz, izz = inertia
    least, middle, largest = np.linalg.eigvalsh([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
    return float(least), float(middle), float(largest)


def _no_body(moments: tuple[float, float, float]) -> str:
    """Why no body has these principal moments, or ''."""
    least, middle, largest = moments
    words = f"its principal moments are {least:.4g}, {middle:.4g}, {largest:.4g} kg m2"
    if least == largest == 0.0:
        return "it has none, as a point"
    if least <= -_ROUNDING * largest:
        return f"{words}, of which none may be negative"
    if largest > (least + middle) * (1.0 + 1e-3):
        return f"{words}, and the largest is above the sum of the others"
    return ""


def _sizes(
    model: ModelText, folder: Path, links: Sequence[LinkText], findings: ModelFindings
) -> dict[str, float]:
    """Diagonals of boxes about links, m: by their shapes, else by the joints that they carry."""
    sizes: dict[str, float] = {}
    told: set[str] = set()
    for link in links:
        extents = [_extent(shape, link.name, folder, told, findings) for shape in link.shapes]
        known = [length_of(extent) for extent in extents if extent is not None]
        # Shapes far apart make the link larger than each of them; so do joints.
        reaches = [length_of(joint.xyz) for joint in model.joints if joint.parent == link.name]
        if known:
            sizes[link.name] = sum(known) + max(reaches, default=0.0)
        elif reaches and max(reaches) > 0.0:
            sizes[link.name] = 2.0 * max(reaches)
    return sizes


def _extent(
    shape: ShapeText, link: str, folder: Path, told: set[str], findings: ModelFindings
) -> Vector3 | None:
    """Edges of the box about a shape, m. Meshes that are missing or oddly large are told once."""
    if not shape.file:
        return shape.size
    path, key, first = find_mesh(shape.file, folder), link_key(link), shape.file not in told
    told.add(shape.file)
    if path is None:
        if first:
            findings.tell("IRL662", key, file=shape.file, cause="there is no such file")
        return None
    try:
        vertices = read_mesh(Mesh(str(path), shape.scale)).vertices
    except MeshFileError as cause:
        if first:
            findings.tell("IRL662", key, file=shape.file, cause=cause.reason)
        return None
    x, y, z = (float(edge) for edge in np.ptp(vertices, axis=0))
    largest = max(x, y, z)
    if first and not _SMALLEST <= largest <= _LARGEST:
        findings.tell("IRL661", key, file=shape.file, link=link, extent=f"{largest:.4g}")
    return x, y, z
