"""Names of files, which need not be text, as text."""

from __future__ import annotations


def legible(name: str) -> str:
    """A name with those of its bytes that are no UTF-8 as escapes, as messages have them."""
    return name.encode("utf-8", "backslashreplace").decode("utf-8")
