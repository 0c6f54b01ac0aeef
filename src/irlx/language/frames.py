"""Frames of the cell in a program: what is said of names that the cell lacks."""

from __future__ import annotations

from collections.abc import Collection

from irlx.diagnostics import Diagnostic, Place, report
from irlx.diagnostics.diagnostic import near_matches

__all__ = ["unknown_frame"]


def unknown_frame(name: str, known: Collection[str], place: Place) -> Diagnostic:
    """The finding, IRL290, on a name after IN FRAME that is none of those `known` in the cell."""
    names = sorted(known)
    return report(
        "IRL290", place, name=name, near=near_matches(name, names), known=", ".join(names) or "none"
    )
