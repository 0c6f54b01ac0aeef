"""Names of the obstacles and groups of a cell; no numeric library is loaded for them."""

from __future__ import annotations

from pathlib import Path
from unicodedata import normalize

from irlx.cell.frame_names import cell_table


def obstacle_names(path: Path) -> tuple[str, ...]:
    """Names under `[[obstacle]]`, of groups as well, as the cell writes them, in NFC as in programs.

    None of them where the file is at fault: what is wrong with a cell is told when it is loaded.
    """
    tables = cell_table(path).get("obstacle")
    if not isinstance(tables, list):
        return ()
    names = (table.get("name") for table in tables if isinstance(table, dict))
    return tuple(normalize("NFC", name) for name in names if isinstance(name, str))
