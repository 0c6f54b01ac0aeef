"""What a replay shows beside the rows of a run."""

from __future__ import annotations

from dataclasses import dataclass

from irlx.cell.cell import Cell


@dataclass(frozen=True, eq=False)
class ReplaySource:
    """The cell of a run and the text of its program, None where that is not known."""

    cell: Cell
    program_text: str | None = None
