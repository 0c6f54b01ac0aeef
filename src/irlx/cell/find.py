"""Finding the cell file of a program; loads no numeric library."""

from __future__ import annotations

from pathlib import Path

from irlx.cell.errors import CellError
from irlx.diagnostics import Place, report


def find_cell(candidates: list[Path], specification: Place | None) -> Path:
    """First of the candidates that exists. Raises CellError, IRL609, that lists what was tried."""
    for path in candidates:
        if path.is_file():
            return path
    tried = ", ".join(str(path) for path in candidates)
    raise CellError(report("IRL609", specification, tried=tried))
