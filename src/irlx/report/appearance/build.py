"""Cell -> what it looks like."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from irlx.cell.cell import Cell
from irlx.cell.looks import RobotLooks, robot_looks
from irlx.cell.obstacle_shape import INSTALL_MESHES
from irlx.diagnostics import Diagnostic, Place, report
from irlx.report.appearance.model import (
    CellAppearance,
    DrawnJoint,
    DrawnLink,
    DrawnObstacle,
    Part,
    RobotAppearance,
)
from irlx.report.appearance.stick_figure import moved_joints, stick_figure
from irlx.robot.description import Joint, JointKind, RobotDescription
from irlx.robot.link_visuals import Visual
from irlx.solids.colour import Colour
from irlx.solids.mesh_file import MeshFileError, MeshReaderMissing
from irlx.solids.painted_mesh import PaintedSurface, read_painted_mesh
from irlx.solids.placement import Placement
from irlx.solids.shape import Mesh, Solid
from irlx.solids.simplify import fair_shares, simplified
from irlx.solids.triangles import Triangles

TRIANGLES = 100_000
"""Triangles of all meshes of a robot, and again of all obstacles; more are simplified."""

_Drawn = tuple[Solid, Colour | None]


def appearance_of(cell: Cell, triangles: int = TRIANGLES) -> CellAppearance:
    """Robot and obstacles of a cell as they look, their meshes simplified to so many `triangles` each.

    A link is drawn by its visuals; by its collision solids where it has none, or where one of them cannot be
    drawn, which a warning, IRL721, tells; a robot without any shape as sticks between its joints. Where the
    cell has moved joints by `origins`, shapes stay as the model has them, and a stick leads to the joint.
    """
    return CellAppearance(_robot(cell, triangles), _obstacles(cell, triangles))


def _robot(cell: Cell, triangles: int) -> RobotAppearance:
    robot, looks = cell.robot, robot_looks(cell)
    faults = list(looks.faults)
    parts = _parts_by_link(robot, looks, faults, triangles)
    if parts:
        for link, sticks in moved_joints(robot, looks.moved_from).items():
            parts.setdefault(link, []).extend(sticks)
    else:
        parts = stick_figure(robot)
    place = Place(cell.file, key="robot.model")
    told = tuple(report("IRL721", place, link=link, cause=cause) for link, cause in faults)
    return _tree(robot, parts, told)


def _parts_by_link(
    robot: RobotDescription, looks: RobotLooks, faults: list[tuple[str, str]], triangles: int
) -> dict[str, list[Part]]:
    """Parts of the links that have any; links whose meshes cannot be drawn go to `faults`."""
    wanted: dict[str, list[_Drawn]] = {}
    for link in (robot.root, *(joint.child for joint in robot.joints)):
        drawn = [_drawn(visual) for visual in looks.by_link.get(link, ())]
        try:
            _surfaces(drawn)
        except MeshFileError as cause:
            faults.append((link, _words(cause)))
            drawn = []
        if not drawn:
            drawn = _readable([(solid, None) for solid in robot.solids.get(link, ())])
        if drawn:
            wanted[link] = drawn
    every = [drawn for of_link in wanted.values() for drawn in of_link]
    try:
        simple = _simple(_surfaces(every), triangles)
    except MeshFileError as cause:
        faults.append((robot.root, _words(cause)))
        return {link: _primitives(drawn) for link, drawn in wanted.items()}
    return {link: _parts(drawn, simple) for link, drawn in wanted.items()}


def _words(cause: MeshFileError) -> str:
    helps = f": {INSTALL_MESHES}" if isinstance(cause, MeshReaderMissing) else ""
    return f"{cause.reason}{helps}"


def _drawn(visual: Visual) -> _Drawn:
    return visual.solid, visual.colour


def _readable(drawn: Iterable[_Drawn]) -> list[_Drawn]:
    """Those whose meshes can be read; a page lacks the others."""
    found = []
    for one in drawn:
        try:
            _surfaces([one])
        except MeshFileError:
            continue
        found.append(one)
    return found


def _primitives(drawn: Iterable[_Drawn]) -> list[Part]:
    return _parts([one for one in drawn if not isinstance(one[0].shape, Mesh)], {})


def _surfaces(drawn: Iterable[_Drawn]) -> dict[Mesh, tuple[PaintedSurface, ...]]:
    """Surfaces of all meshes among some solids. Raises MeshFileError."""
    meshes = (solid.shape for solid, _ in drawn)
    return {mesh: read_painted_mesh(mesh) for mesh in meshes if isinstance(mesh, Mesh)}


def _simple(
    surfaces: Mapping[Mesh, Sequence[PaintedSurface]], triangles: int
) -> dict[Mesh, tuple[PaintedSurface, ...]]:
    """The surfaces with so many `triangles` in all, each mesh a fair share of them. Raises MeshFileError."""
    sizes = {mesh: sum(len(one.surface.faces) for one in found) for mesh, found in surfaces.items()}
    share = fair_shares(list(sizes.values()), triangles)
    return {
        mesh: tuple(
            PaintedSurface(_cut(one.surface, min(1.0, share / sizes[mesh])), one.colour) for one in found
        )
        for mesh, found in surfaces.items()
    }


def _cut(surface: Triangles, part: float) -> Triangles:
    return surface if part == 1.0 else simplified(surface, max(4, round(part * len(surface.faces))))


def _parts(drawn: Iterable[_Drawn], surfaces: Mapping[Mesh, Sequence[PaintedSurface]]) -> list[Part]:
    parts = []
    for solid, colour in drawn:
        if isinstance(solid.shape, Mesh):
            own = surfaces[solid.shape]
            parts += [Part(one.surface, solid.placement, colour or one.colour) for one in own]
        else:
            parts.append(Part(solid.shape, solid.placement, colour))
    return parts


def _tree(
    robot: RobotDescription, parts: Mapping[str, Sequence[Part]], told: tuple[Diagnostic, ...]
) -> RobotAppearance:
    """The links depth first, with their parts."""
    children: dict[str, list[Joint]] = {}
    for joint in robot.joints:
        children.setdefault(joint.parent, []).append(joint)
    axes = {joint.name: way for joint, way in zip(robot.moving, robot.coupling, strict=True)}
    links: list[DrawnLink] = []
    waiting: list[tuple[str, int | None, DrawnJoint | None]] = [(robot.root, None, None)]
    while waiting:
        name, parent, drawn = waiting.pop()
        number = len(links)
        links.append(DrawnLink(name, parent, drawn, tuple(parts.get(name, ()))))
        below = [(joint.child, number, _joint(robot, joint, axes)) for joint in children.get(name, ())]
        waiting += reversed(below)
    names = [link.name for link in links]
    return RobotAppearance(robot.name, tuple(links), names.index(robot.tip), told)


def _joint(robot: RobotDescription, joint: Joint, axes: Mapping[str, tuple[int, float, float]]) -> DrawnJoint:
    kind = "revolute" if joint.kind is JointKind.CONTINUOUS else joint.kind.value
    way = axes.get(joint.name, (None, 1.0, robot.locked.get(joint.name, 0.0)))
    return DrawnJoint(joint.name, kind, Placement.from_rpy(joint.xyz, joint.rpy), joint.axis, *way)


def _obstacles(cell: Cell, triangles: int) -> tuple[DrawnObstacle, ...]:
    """Obstacles of a loaded cell, whose meshes have been read before."""
    obstacles = cell.scene.obstacles.values()
    plain: dict[str, list[_Drawn]] = {
        one.name: _readable([(solid, None) for solid in one.solids]) for one in obstacles
    }
    try:
        simple = _simple(_surfaces(drawn for own in plain.values() for drawn in own), triangles)
    except MeshFileError:
        # Without the library that simplifies, obstacles are drawn as their files have them.
        simple = _surfaces(drawn for own in plain.values() for drawn in own)
    return tuple(DrawnObstacle(one, tuple(_parts(plain[one.name], simple))) for one in obstacles)
