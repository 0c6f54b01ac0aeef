"""A cell file as a table, and the names of its frames: no numeric library is loaded for them."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, Protocol
from unicodedata import normalize

from irlx.diagnostics.whole_file import whole_file

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


class Readable(Protocol):
    """A file on disk, or one that comes with irlx."""

    def read_bytes(self) -> bytes:
        """Its content."""
        ...


def frame_names(path: Path) -> Mapping[str, bool] | None:
    """Names under `[frames]`, normalised as names of programs are, each with whether it moves with a link.

    None where the file is at fault: what is wrong with a cell is told when it is loaded; here it would only
    be told twice.
    """
    table = cell_table(path)
    frames = table.get("frames", {})
    if not table or not isinstance(frames, dict):
        return None
    moves = {name: isinstance(frame, dict) and "link" in frame for name, frame in frames.items()}
    return {normalize("NFC", name): moving for name, moving in moves.items()}


def cell_table(file: Readable) -> dict[str, Any]:
    """A cell file as a table, empty where it is none."""
    try:
        content = whole_file(file) if isinstance(file, Path) else file.read_bytes()
        return _table(content)
    except (OSError, ValueError, RecursionError):
        return {}


@lru_cache(maxsize=2)
def _table(content: bytes) -> dict[str, Any]:
    """A cell as a table, not to be written to: of frames and of obstacles it is asked in turn."""
    table: dict[str, Any] = tomllib.loads(content.decode("utf-8-sig"))
    return table
