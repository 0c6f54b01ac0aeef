"""What the links of a cell's robot look like."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from irlx.cell.cell import Cell
from irlx.cell.link_meshes import find_mesh
from irlx.cell.named import named_urdf, robot_names, urdf_folder
from irlx.diagnostics import IrlxError, Place
from irlx.diagnostics.whole_file import whole_text
from irlx.robot.link_visuals import Visual, link_visuals
from irlx.robot.urdf import read_urdf
from irlx.solids.placement import Vector3
from irlx.solids.shape import Mesh


@dataclass(frozen=True)
class RobotLooks:
    """Visuals by link, mesh files with absolute paths, of every link that has any that can be drawn.

    `faults` tells, link and reason, why others have none. `moved_from` are the joints that the cell has put
    elsewhere by `origins`, and where (m, in the parent link) the model has them, and shapes expect them.
    """

    by_link: Mapping[str, tuple[Visual, ...]]
    faults: tuple[tuple[str, str], ...] = ()
    moved_from: Mapping[str, Vector3] = field(default_factory=dict)


def robot_looks(cell: Cell) -> RobotLooks:
    """Looks of a cell's robot, for which its URDF is read once more."""
    folder = Path(cell.file).parent
    if not (folder / cell.model).exists():
        # A cell without a file of its own names its model from the working folder.
        folder = Path()
    try:
        text = _urdf(cell, folder)
        found, model = link_visuals(text), read_urdf(text, cell.robot.tip)
    except (OSError, ValueError, SyntaxError, IrlxError) as cause:
        # The cell was loaded from that very file: somebody has changed it since.
        return RobotLooks({}, ((cell.robot.root, f"its model cannot be read again ({cause})"),))
    by_link, faults = {}, list(found.faults)
    meshes = urdf_folder(cell.model, folder)
    for link, visuals in found.by_link.items():
        placed = [_with_file(visual, meshes) for visual in visuals]
        if lost := [name for name in placed if isinstance(name, str)]:
            faults.append((link, f"there is no mesh {lost[0]}"))
        else:
            by_link[link] = tuple(visual for visual in placed if not isinstance(visual, str))
    places = {joint.name: joint.xyz for joint in model.joints}
    moved = {
        joint.name: places[joint.name]
        for joint in cell.robot.joints
        if places.get(joint.name, joint.xyz) != joint.xyz
    }
    return RobotLooks(by_link, tuple(faults), moved)


def _urdf(cell: Cell, folder: Path) -> str:
    if cell.model in robot_names():
        return named_urdf(cell.model, Place(cell.file, key="robot.model"))
    return whole_text(folder / cell.model)


def _with_file(visual: Visual, folder: Path | None) -> Visual | str:
    """The visual with the path of its mesh file, or the name of a file that is not there."""
    shape = visual.solid.shape
    if not isinstance(shape, Mesh):
        return visual
    path = None if folder is None else find_mesh(shape.file, folder)
    if path is None:
        return shape.file
    return replace(visual, solid=replace(visual.solid, shape=replace(shape, file=str(path))))
