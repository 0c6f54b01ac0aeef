"""Names of page files, and of files in pages."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

from irlx.diagnostics import Diagnostic

ENDINGS = (".html", ".htm")


def is_page(path: str | os.PathLike[str]) -> bool:
    """Whether a file is a page by its ending."""
    return Path(path).suffix.lower() in ENDINGS


def words_of(diagnostic: Diagnostic) -> str:
    """A diagnostic in one line, its file named without folders, as program and cell are.

    A page is the same from whatever folder the run is called, and tells nobody where its maker keeps files.
    """
    place = diagnostic.place
    if place is None:
        return str(diagnostic)
    return str(replace(diagnostic, place=replace(place, file=Path(place.file).name)))
