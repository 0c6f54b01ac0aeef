"""Finds the grammar: beside the package in a wheel, at the top of the repository in a working copy."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

__all__ = ["grammar_file", "grammar_text"]

_PACKAGE = Path(__file__).resolve().parent.parent


def grammar_file(name: str) -> Path:
    """Path of a file of the grammar; FileNotFoundError names both places when the installation is damaged."""
    places = (_PACKAGE / "grammar" / name, _PACKAGE.parent.parent / "grammar" / name)
    for place in places:
        if place.is_file():
            return place
    raise FileNotFoundError(f"no {name} at " + " or at ".join(str(place) for place in places))


@lru_cache(maxsize=1)
def grammar_text() -> str:
    """Text of ``irl.lark``."""
    return grammar_file("irl.lark").read_text(encoding="utf-8")
