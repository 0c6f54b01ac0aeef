"""The text of a program as HTML, the line in execution lit."""

from __future__ import annotations

from html import escape

from irlx.diagnostics import SourceText, Span
from irlx.language.keywords import keyword_table
from irlx.language.lexing import lex, token_span

_LINES = 33
"""Lines that are shown at once; of a longer text those around the one in execution."""
_KEYWORD = "color: var(--mantine-color-blue-text, #1c64b5); font-weight: 600"
_COMMENT = "color: #868e96; font-style: italic"
_STRING = "color: var(--mantine-color-teal-text, #0a7d5a)"
_LIT = "background: rgba(250, 176, 5, .38); box-shadow: inset 3px 0 #f08c00"


class ProgramHtml:
    """Lines of a text as HTML, coloured once, put together for each line that is lit."""

    def __init__(self, text: SourceText) -> None:
        self._lines = _coloured_lines(text)

    def lit(self, line: int) -> str:
        """The text, or as much of it as is shown at once, with a line lit; 0 for none."""
        count = len(self._lines)
        first = max(0, min(line - 1 - _LINES // 2, count - _LINES)) if count > _LINES else 0
        rows = []
        for number in range(first + 1, min(first + _LINES, count) + 1):
            style = f' style="{_LIT}"' if number == line else ""
            gutter = f'<span style="color: #adb5bd; user-select: none">{number:>4}  </span>'
            mark = ' data-lit="1"' if number == line else ""
            rows.append(f"<div{mark}{style}>{gutter}{self._lines[number - 1] or ' '}</div>")
        box = (
            "font: 11.5px/1.45 ui-monospace, SFMono-Regular, Menlo, Consolas, monospace; white-space: pre; "
            "overflow-x: auto; margin: 2px 0; padding: 4px 6px"
        )
        return f'<div style="{box}">{"".join(rows)}</div>'


def _coloured_lines(text: SourceText) -> list[str]:
    """The lines of a text with its keywords, comments and strings in spans of their own."""
    lexed = lex(text)
    keywords = set(keyword_table().values()) | set(keyword_table())
    marked: list[tuple[Span, str]] = [(span, _COMMENT) for span in lexed.comments]
    for token in lexed.tokens:
        span = token_span(token)
        if token.type == "STRING":
            marked.append((span, _STRING))
        elif token.type in keywords or text.text[span.start : span.end].upper() in keywords:
            marked.append((span, _KEYWORD))
    parts, at = [], 0
    for span, style in sorted(marked, key=lambda one: one[0].start):
        if span.start < at:
            continue
        parts.append(escape(text.text[at : span.start]))
        # A comment over several lines is a span on each of them.
        pieces = text.text[span.start : span.end].split("\n")
        parts.append("\n".join(f'<span style="{style}">{escape(piece)}</span>' for piece in pieces))
        at = span.end
    parts.append(escape(text.text[at:]))
    lines = "".join(parts).split("\n")
    return lines[:-1] if lines and not lines[-1] else lines
