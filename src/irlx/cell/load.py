"""Loading a cell file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from irlx.cell.bound_frames import bound_links
from irlx.cell.build import build_cell
from irlx.cell.cell import Cell
from irlx.cell.errors import CellError
from irlx.cell.model import load_robot, with_packaged_defaults, without_absent_joints
from irlx.cell.obstacles import read_obstacles
from irlx.cell.read import read_in_parts
from irlx.cell.schema import CellFile, RobotSection
from irlx.diagnostics import Diagnostic, Place, report
from irlx.diagnostics.near_files import near_files
from irlx.diagnostics.whole_file import whole_file


def load_cell(path: Path) -> Cell:
    """Cell of a file. Raises CellError with every fault; IRL001, IRL002, IRL007 where it cannot be read."""
    file = str(path)
    read = read_in_parts(read_bytes(path), file)
    if read.content is None:
        raise CellError(read.faults)
    try:
        if not read.same_robot:
            raise CellError([*read.faults, *_of_obstacles(read.content, file)])
        return _built(read.content, file, path.parent, read.faults)
    except CellError as error:
        further = [one for one in error.diagnostics if one not in read.faults and read.is_new(one)]
        raise CellError([*read.faults, *further]) from None


def own_cell(model: str) -> Cell:
    """Cell with nothing in it but a robot, that of a name or of a URDF at a path, as it is by itself.

    Raises CellError as `load_cell` does, IRL611 for a name that is not known.
    """
    file = f"{model} (its own cell)"
    return _built(CellFile(robot=RobotSection(model=model)), file, Path())


def _built(content: CellFile, file: str, folder: Path, faults: Sequence[Diagnostic] = ()) -> Cell:
    """The cell of what a file holds, which has had `faults`. Raises CellError with every fault."""
    section = with_packaged_defaults(content.robot)
    try:
        robot = load_robot(section, file, folder, bound_links(content))
    except CellError as error:
        # Without a robot obstacles can be looked at all the same.
        raise CellError([*error.diagnostics, *_of_obstacles(content, file)]) from error
    section = without_absent_joints(section, content.robot, robot)
    return build_cell(content, section, robot, file, faults)


def _of_obstacles(content: CellFile, file: str) -> list[Diagnostic]:
    """What is wrong with the obstacles of a file."""
    found: list[Diagnostic] = []
    read_obstacles(content, file, found, [])
    return found


def read_bytes(path: Path) -> bytes:
    """Bytes of a cell file. Raises CellError: IRL001 missing, IRL002 unreadable, IRL007 a folder."""
    try:
        return whole_file(path)
    except FileNotFoundError as cause:
        raise CellError(report("IRL001", path=path, near=near_files(path))) from cause
    except IsADirectoryError as cause:
        raise CellError(report("IRL007", path=path)) from cause
    except (OSError, ValueError) as cause:
        words = cause.strerror if isinstance(cause, OSError) else str(cause)
        raise CellError(report("IRL002", Place(str(path)), path=path, cause=words)) from cause
