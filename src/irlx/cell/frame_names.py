"""A cell file as a table, and the names of its frames: no numeric library is loaded for them."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any, Protocol
from unicodedata import normalize

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


class Readable(Protocol):
    """A file on disk, or one that comes with irlx."""

    def read_bytes(self) -> bytes:
        """Its content."""
        ...


def frame_names(path: Path) -> tuple[str, ...]:
    """Names under `[frames]`, normalised as names of programs are; none where the file is at fault.

    What is wrong with a cell is told when it is loaded; here it would only be told twice.
    """
    frames = cell_table(path).get("frames")
    return tuple(normalize("NFC", name) for name in frames) if isinstance(frames, dict) else ()


def cell_table(file: Readable) -> dict[str, Any]:
    """A cell file as a table, empty where it is none."""
    try:
        table: dict[str, Any] = tomllib.loads(file.read_bytes().decode("utf-8-sig"))
    except (OSError, ValueError, RecursionError):
        return {}
    return table
