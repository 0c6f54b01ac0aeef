"""Mends what the parser forgives: a missing THEN, DO or ``;``, and ``=`` for ``:=``."""

from __future__ import annotations

from collections.abc import Sequence

from irlx.diagnostics import Diagnostic

__all__ = ["REPAIRED", "repaired"]

REPAIRED = frozenset({"IRL103", "IRL104", "IRL105"})
"""Codes of what is mended."""


def repaired(text: str, findings: Sequence[Diagnostic]) -> str:
    """The text with what these findings of its parse ask for."""
    edits = [edit for finding in findings if (edit := _edit(finding)) is not None]
    # From the end on, so that the offsets of those before stay true; the order at one place stays, too.
    for start, end, new in sorted(edits, key=lambda edit: edit[0], reverse=True):
        text = text[:start] + new + text[end:]
    return text


def _edit(finding: Diagnostic) -> tuple[int, int, str] | None:
    """Start, end and what is to stand between."""
    span = finding.place.span if finding.place is not None else None
    if span is None or finding.code not in REPAIRED:
        return None
    if finding.code == "IRL103":
        return span.start, span.start, ";"
    if finding.code == "IRL104":
        return span.start, span.start, f" {finding.data['word']}"
    return span.start, span.end, ":="
