"""Diagnostics as a notebook shows them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

from irlx.diagnostics import Diagnostic, Severity
from irlx.diagnostics.text import render_text

_COLOURS = {
    Severity.ERROR: "var(--jp-error-color1, #d32f2f)",
    Severity.WARNING: "var(--jp-warn-color1, #b26a00)",
    Severity.INFO: "var(--jp-info-color1, #0277bd)",
}
"""Of the words that name severity and code: those of the notebook's theme, readable on light and dark."""


@dataclass(frozen=True)
class Findings:
    """Diagnostics with place, excerpt and caret: text in a terminal, the same text coloured in a notebook."""

    diagnostics: tuple[Diagnostic, ...]

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        object.__setattr__(self, "diagnostics", tuple(diagnostics))

    def __repr__(self) -> str:
        return "\n".join(map(render_text, self.diagnostics))

    def _repr_html_(self) -> str:
        """The text of all of them as HTML; what it quotes of programs is escaped."""
        style = "white-space: pre; overflow-x: auto; margin: 0 0 .6em; line-height: 1.35"
        parts = (f'<pre style="{style}">{_html(found)}</pre>' for found in self.diagnostics)
        return f'<div class="irlx-findings">{"".join(parts)}</div>'


def _html(found: Diagnostic) -> str:
    words = f"{found.severity.value} {found.code}"
    text = escape(render_text(found))
    marked = f'<b style="color: {_COLOURS[found.severity]}">{words}</b>'
    return text.replace(words, marked, 1)
