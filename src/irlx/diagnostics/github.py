"""Renderer of diagnostics as workflow commands, which GitHub shows beside the changed lines."""

from __future__ import annotations

from irlx.diagnostics.diagnostic import Diagnostic
from irlx.diagnostics.place import Place

__all__ = ["render_github"]

_COMMANDS = {"error": "error", "warning": "warning", "info": "notice"}


def render_github(diagnostic: Diagnostic) -> str:
    """One ``::error file=..,line=..::message`` line."""
    properties = {**_place(diagnostic.place), "title": diagnostic.code}
    words = ",".join(f"{name}={_property(str(value))}" for name, value in properties.items())
    message = f"{diagnostic.message}\n{diagnostic.help}" if diagnostic.help else diagnostic.message
    if diagnostic.place is not None and diagnostic.place.key:
        message = f"{diagnostic.place.key}: {message}"
    return f"::{_COMMANDS[diagnostic.severity.value]} {words}::{_data(message)}"


def _place(place: Place | None) -> dict[str, object]:
    if place is None:
        return {}
    start, end = place.line_and_column, place.end_line_and_column
    if start is None or end is None:
        return {"file": place.file}
    properties: dict[str, object] = {"file": place.file, "line": start[0]}
    if end[0] != start[0]:
        # GitHub takes columns only where an annotation stands on one line.
        return {**properties, "endLine": end[0]}
    return {**properties, "col": start[1], "endColumn": max(end[1], start[1] + 1)}


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
