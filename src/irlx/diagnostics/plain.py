"""Diagnostics as JSON-able data; `docs/reference/interface.md` promises its shape."""

from __future__ import annotations

from irlx.diagnostics.diagnostic import Diagnostic
from irlx.diagnostics.place import Place

__all__ = ["plain_diagnostic"]


def plain_diagnostic(diagnostic: Diagnostic) -> dict[str, object]:
    """One diagnostic; every key is always there, None where it has no value."""
    return {
        "code": diagnostic.code,
        "severity": diagnostic.severity.value,
        "message": diagnostic.message,
        "help": diagnostic.help or None,
        **_plain_place(diagnostic.place),
        "related": [{"message": one.message, **_plain_place(one.place)} for one in diagnostic.related],
    }


def _plain_place(place: Place | None) -> dict[str, object]:
    """`place` is the whole in words; lines and columns count characters from 1, the end is just after."""
    start = (place.line_and_column if place else None) or (None, None)
    end = (place.end_line_and_column if place else None) or (None, None)
    return {
        "place": str(place or ""),
        "file": place.file if place else None,
        "line": start[0],
        "column": start[1],
        "end_line": end[0],
        "end_column": end[1],
        "key": (place.key if place else "") or None,
    }
