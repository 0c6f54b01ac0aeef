"""What a program may know of its cell before it runs: the same for a check and for the start of a run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from irlx.cell.errors import CellError
from irlx.cell.frame_names import cell_table, frame_names
from irlx.cell.obstacle_names import obstacle_names
from irlx.cell.toml import cell_toml
from irlx.diagnostics import Diagnostic, Place, report
from irlx.diagnostics.whole_file import whole_file

if TYPE_CHECKING:
    from irlx.cell.cell import Cell


@dataclass(frozen=True)
class KnownCell:
    """Names that a cell gives to programs, and joints of its robot.

    `frames` say which of them move with a link of the robot. They and `obstacles` are None where no cell is
    known, `joints` empty where the robot is not.
    """

    frames: Mapping[str, bool] | None = None
    obstacles: tuple[str, ...] | None = None
    joints: tuple[str, ...] = ()

    def tells_the_same(self, other: KnownCell) -> bool:
        """Whether no program can be right with one of them and wrong with the other."""
        return (
            self.frames == other.frames
            and self.joints == other.joints
            and _keys(self.obstacles) == _keys(other.obstacles)
        )


def _keys(names: tuple[str, ...] | None) -> set[str] | None:
    return None if names is None else {name.casefold() for name in names}


def known_of_file(path: Path) -> KnownCell:
    """What the file of a cell tells, without loading the cell or any numeric library.

    What is wrong with a cell is told when it is loaded; what it says nothing of is not known here.
    """
    # Imported here: a program without a cell needs no reader of robots.
    from irlx.cell.joint_names import joint_names

    # A cell that is no TOML has no names to miss.
    obstacles = obstacle_names(path) if cell_table(path) else None
    return KnownCell(frame_names(path), obstacles, joint_names(path))


def unreadable(path: Path) -> list[Diagnostic]:
    """Why nothing of a cell file can be read: IRL601 where it is no TOML; none where it can."""
    try:
        cell_toml(whole_file(path), str(path))
    except CellError as error:
        return list(error.diagnostics)
    except (OSError, ValueError) as cause:
        words = cause.strerror if isinstance(cause, OSError) and cause.strerror else str(cause)
        return [report("IRL002", Place(str(path)), path=path, cause=words)]
    return []


def known_of(cell: Cell) -> KnownCell:
    """What a cell that has been loaded tells."""
    frames = {name: name in cell.link_frames for name in (*cell.frames, *cell.link_frames)}
    return KnownCell(frames, cell.scene.names, cell.robot.joint_names)
