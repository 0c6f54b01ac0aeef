"""Names of page files."""

from __future__ import annotations

import os
from pathlib import Path

ENDINGS = (".html", ".htm")


def is_page(path: str | os.PathLike[str]) -> bool:
    """Whether a file is a page by its ending."""
    return Path(path).suffix.lower() in ENDINGS
