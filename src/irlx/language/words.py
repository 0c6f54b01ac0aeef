"""Numbers of things in words."""

from __future__ import annotations

__all__ = ["count"]


def count(number: int, noun: str, nouns: str = "") -> str:
    """A number of things in words: ``1 value``, ``2 values``."""
    return f"{number} {noun}" if number == 1 else f"{number} {nouns or noun + 's'}"
