"""Files beside a missing one with a name like it."""

from __future__ import annotations

from pathlib import Path

from irlx.diagnostics.diagnostic import near_matches


def near_files(path: Path) -> str:
    """Clause with the files of the same ending whose names are like that of `path`, or ''."""
    try:
        names = sorted(entry.name for entry in path.parent.iterdir() if entry.suffix == path.suffix)
    except (OSError, ValueError):
        return ""
    return near_matches(path.name, names)
