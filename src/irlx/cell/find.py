"""Finding the cell file of a program; loads no numeric library."""

from __future__ import annotations

from pathlib import Path

from irlx.cell.errors import CellError
from irlx.diagnostics import Place, report


def is_file(path: Path) -> bool:
    """Whether a file is there; a name that no file system takes is none."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def find_cell(candidates: list[Path], specification: Place | None) -> Path:
    """First of the candidates that exists. Raises CellError, IRL609, that lists what was tried."""
    for path in candidates:
        if is_file(path):
            return path
    tried = ", ".join(str(path) for path in candidates)
    raise CellError(report("IRL609", specification, tried=tried))
