"""Files that a run writes, beside those that it reads."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from irlx.report.file_recording import partial_name

__all__ = ["overwrites", "written"]


def overwrites(output: Path, source: Path) -> bool:
    """Whether an output is an input, maybe by another name, or a folder that an input stands in."""
    if not (output.exists() and source.exists()):
        return False
    return output.samefile(source) or source.resolve().is_relative_to(output.resolve())


def written(outputs: Iterable[Path]) -> tuple[Path, ...]:
    """Every name under which what is asked for may appear, also of a run that does not come to its end."""
    names = tuple(outputs)
    return (*names, *map(partial_name, names))
