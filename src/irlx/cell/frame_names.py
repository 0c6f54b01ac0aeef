"""Names of the frames of a cell file, read without loading the cell or any numeric library."""

from __future__ import annotations

import sys
from pathlib import Path
from unicodedata import normalize

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


def frame_names(path: Path) -> tuple[str, ...]:
    """Names under `[frames]`, normalised as names of programs are; none where the file is at fault.

    What is wrong with a cell is told when it is loaded; here it would only be told twice.
    """
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except (OSError, ValueError, RecursionError):
        return ()
    frames = table.get("frames")
    return tuple(normalize("NFC", name) for name in frames) if isinstance(frames, dict) else ()
