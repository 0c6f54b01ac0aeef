"""The page of each code: inside the package in a wheel, under `docs` in a working copy."""

from __future__ import annotations

from pathlib import Path

from irlx.diagnostics.codes import CATALOGUE

__all__ = ["page_text", "page_title"]

_PACKAGE = Path(__file__).resolve().parent.parent
_FOLDER = Path("docs", "diagnostics")


def page_text(code: str) -> str:
    """Markdown of the page of a code.

    Raises KeyError for no code, FileNotFoundError that names both places when the installation is damaged.
    """
    name = f"{CATALOGUE[code].id}.md"
    places = [root / _FOLDER / name for root in (_PACKAGE, _PACKAGE.parent.parent)]
    for place in places:
        if place.is_file():
            return place.read_text(encoding="utf-8")
    raise FileNotFoundError(f"no {name} at " + " or at ".join(str(place) for place in places))


def page_title(code: str) -> str:
    """What the first line of the page says of the code."""
    first, _, _ = page_text(code).partition("\n")
    return first.removeprefix(f"# {code}:").strip()
