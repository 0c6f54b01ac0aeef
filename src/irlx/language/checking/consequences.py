"""Findings on types that follow from a mistake in the text, which is told already."""

from __future__ import annotations

from collections.abc import Iterable

from irlx.diagnostics import Diagnostic
from irlx.language.parsing.driver import MAX_ERRORS


def standing_alone(findings: list[Diagnostic], syntax: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Findings away from mistakes in the text: beside one, words are missing or have been guessed.

    None where the text has more mistakes than are told: any of these may be the cause.
    """
    syntax = [mistake for mistake in syntax if mistake.is_error]
    if len(syntax) >= MAX_ERRORS:
        return []
    torn: set[tuple[str, int]] = set()
    for mistake in syntax:
        place = mistake.place
        if place is not None and place.line is not None:
            torn.update((place.file, place.line + near) for near in (-1, 0, 1))
    if not torn:
        return findings
    return [f for f in findings if f.place is None or (f.place.file, f.place.line) not in torn]
