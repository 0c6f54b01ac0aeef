"""Numbers of things in words."""

from __future__ import annotations


def count(number: int, noun: str, nouns: str = "") -> str:
    """A number of things in words: ``1 value``, ``2 values``."""
    return f"{number} {noun}" if number == 1 else f"{number} {nouns or noun + 's'}"


def alternatives(names: list[str]) -> str:
    """Things of which one is meant: ``a, b or c``."""
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} or {names[-1]}"
