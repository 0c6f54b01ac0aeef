"""Renderer of diagnostics for editors and grep: one line each."""

from __future__ import annotations

from irlx.diagnostics.diagnostic import Diagnostic

__all__ = ["render_concise"]


def render_concise(diagnostic: Diagnostic) -> str:
    """``file:line:column: severity CODE message``, without the line or the place where there is none."""
    place = f"{diagnostic.place}: " if diagnostic.place else ""
    message = " ".join(diagnostic.message.split())
    return f"{place}{diagnostic.severity.value} {diagnostic.code} {message}"
