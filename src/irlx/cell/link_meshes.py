"""Mesh files of a robot's links: where they are, and whether they can be used."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlparse

from irlx.cell.errors import CellError
from irlx.cell.find import is_file
from irlx.cell.named import urdf_folder
from irlx.cell.obstacle_shape import INSTALL_MESHES
from irlx.diagnostics import Diagnostic, Place, report
from irlx.diagnostics.near_files import near_files
from irlx.robot.description import RobotDescription
from irlx.solids.mesh_file import MeshFileError, missing_package, read_mesh
from irlx.solids.shape import Mesh, Solid

_PACKAGE = "package://"


def with_mesh_files(robot: RobotDescription, folder: Path | None) -> RobotDescription:
    """The robot with absolute paths of its links' mesh files; names of files that are not found stay.

    `folder` is that of the URDF.
    """
    if folder is None or not any(isinstance(s.shape, Mesh) for s in _all_solids(robot)):
        return robot
    solids = {link: tuple(_found(solid, folder) for solid in solids) for link, solids in robot.solids.items()}
    return replace(robot, solids=solids)


def resolved_solids(robot: RobotDescription, model: str, cell_file: str) -> Mapping[str, tuple[Solid, ...]]:
    """Solids of a robot that a cell has loaded, every mesh among them one that can be used.

    Its convex hulls are built with that, once a process. `model` and `cell_file` are those of the cell.
    Raises CellError with every file at fault: IRL639 missing, IRL640 unusable, IRL641 without its reader.
    """
    faults = mesh_faults(robot, model, cell_file)
    if not faults:
        # Imported here: hulls need scipy, and most cells have no meshes.
        from irlx.solids.hull import hull_of

        for link, mesh in _meshes(robot):
            try:
                hull_of(read_mesh(mesh))
            except MeshFileError as cause:
                data: dict[str, Any] = {"key": f"link '{link}'", "file": mesh.file, "cause": cause.reason}
                faults.append(report("IRL640", Place(cell_file, key="robot.model"), **data))
    if faults:
        raise CellError(faults)
    return robot.solids


def mesh_faults(robot: RobotDescription, model: str, cell_file: str) -> list[Diagnostic]:
    """Mesh files of a robot's links that are not there (IRL639), or lack their reader (IRL641).

    Each file and each reader is told once; no mesh is read.
    """
    place = Place(cell_file, key="robot.model")
    folder = urdf_folder(model, Path(cell_file).parent)
    faults: dict[str, Diagnostic] = {}
    for link, mesh in _meshes(robot):
        data: dict[str, Any] = {"key": f"link '{link}'", "file": mesh.file}
        if not (Path(mesh.file).is_absolute() and is_file(Path(mesh.file))):
            first = next(_candidates(mesh.file, folder))
            higher = ", and from the folders above" if mesh.file.startswith(_PACKAGE) else ""
            data |= {"tried": f"{first}{higher}", "near": near_files(first)}
            faults.setdefault(mesh.file, report("IRL639", place, **data))
        elif missing := missing_package(mesh):
            data |= {"cause": f"the package {missing} is not installed", "command": INSTALL_MESHES}
            faults.setdefault(missing, report("IRL641", place, **data))
    return list(faults.values())


def find_mesh(name: str, folder: Path) -> Path | None:
    """The file that a URDF in `folder` means by the name of a mesh, None where there is none."""
    return next(filter(is_file, _candidates(name, folder)), None)


def _all_solids(robot: RobotDescription) -> Iterator[Solid]:
    return (solid for solids in robot.solids.values() for solid in solids)


def _meshes(robot: RobotDescription) -> Iterator[tuple[str, Mesh]]:
    """Links and meshes of a robot."""
    for link, solids in robot.solids.items():
        yield from ((link, solid.shape) for solid in solids if isinstance(solid.shape, Mesh))


def _found(solid: Solid, folder: Path) -> Solid:
    if not isinstance(solid.shape, Mesh):
        return solid
    path = find_mesh(solid.shape.file, folder)
    return solid if path is None else replace(solid, shape=replace(solid.shape, file=str(path)))


def _candidates(name: str, folder: Path | None) -> Iterator[Path]:
    """Paths that a URDF in `folder` may mean by the name of a mesh file, the likeliest first.

    ``package://NAME/REST`` lies in a folder NAME beside the URDF or beside a folder that it is in, or that
    folder has another name; else in a ROS workspace. Other names are paths from the URDF's folder.
    """
    folder = (folder or Path()).absolute()
    if not name.startswith(_PACKAGE):
        path = unquote(urlparse(name).path) if name.startswith("file://") else name
        yield folder / path
        return
    # Some URDFs have one slash more than the form asks for.
    rest = Path(name.removeprefix(_PACKAGE).lstrip("/"))
    above = (folder, *folder.parents)
    yield from (base / rest for base in above)
    yield from (base / Path(*rest.parts[1:]) for base in above)
    workspaces = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    yield from (Path(entry).absolute() / "share" / rest for entry in workspaces if entry)
