"""Finds the grammar: beside the package in a wheel, at the top of the repository in a working copy."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

__all__ = ["grammar_text"]

_PACKAGE = Path(__file__).resolve().parent.parent


@lru_cache(maxsize=1)
def grammar_text() -> str:
    """Text of ``irl.lark``; FileNotFoundError names both places when the installation is damaged."""
    places = (_PACKAGE / "grammar" / "irl.lark", _PACKAGE.parent.parent / "grammar" / "irl.lark")
    for place in places:
        if place.is_file():
            return place.read_text(encoding="utf-8")
    raise FileNotFoundError("no irl.lark at " + " or at ".join(str(place) for place in places))
