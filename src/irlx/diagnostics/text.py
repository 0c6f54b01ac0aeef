"""Renderer of diagnostics for people: place, code, message, source excerpt with carets, help."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias
from unicodedata import combining, east_asian_width

from irlx.diagnostics.diagnostic import Diagnostic
from irlx.diagnostics.place import Place, SourceText

__all__ = ["Painter", "render_text"]

TAB_WIDTH = 4
Painter: TypeAlias = Callable[[SourceText, int], str]
"""A text and the number of a line to that line as it is shown: as wide, in colours."""


def _display_width(text: str) -> int:
    if text.isascii() and text.isprintable():
        return len(text)
    return sum(
        0 if combining(c) else TAB_WIDTH if c == "\t" else 2 if east_asian_width(c) in "WF" else 1
        for c in text
    )


def _excerpt(place: Place, paint: Painter) -> list[str]:
    """Source line of a place with carets below the span's part on that line."""
    if place.text is None or place.span is None:
        return []
    line, column = place.text.line_and_column(place.span.start)
    source = place.text.line_text(line)
    length = min(place.span.end - place.span.start, max(len(source) - (column - 1), 0))
    lead = _display_width(source[: column - 1])
    width = max(_display_width(source[column - 1 : column - 1 + length]), 1)
    number = str(line)
    shown = paint(place.text, line).replace("\t", " " * TAB_WIDTH)
    return [f" {number} | {shown}", f" {' ' * len(number)} | {' ' * lead}{'^' * width}"]


def render_text(diagnostic: Diagnostic, paint: Painter = SourceText.line_text) -> str:
    """Text of one diagnostic, several lines, in the colours of `paint`, if any; ends without a line end."""
    lines = [str(diagnostic)]
    if diagnostic.place is not None:
        lines += _excerpt(diagnostic.place, paint)
    for related in diagnostic.related:
        lines.append(f"  {related.place}: {related.message}")
        lines += _excerpt(related.place, paint)
    if diagnostic.help:
        lines.append(f"  help: {diagnostic.help}")
    return "\n".join(lines)
