"""Files beside a missing one with a name like it."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

from irlx.diagnostics.diagnostic import near_matches


def near_files(path: Path) -> str:
    """Clause with the files of the same ending whose names are like that of `path`, or ''."""
    return near_matches(path.name, sorted(file.name for file in _beside(path)))


def near_names(path: Path, others: Collection[Path] = ()) -> str:
    """The same by names without the ending; `others` are none that can be meant."""
    return near_matches(path.stem, sorted(file.stem for file in _beside(path) if file not in others))


def _beside(path: Path) -> list[Path]:
    """Files with the ending of `path` in its folder; none where that cannot be listed."""
    try:
        return [entry for entry in path.parent.iterdir() if entry.suffix == path.suffix]
    except (OSError, ValueError):
        return []
