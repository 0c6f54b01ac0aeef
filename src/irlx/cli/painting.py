"""Colours of program text on a terminal."""

from __future__ import annotations

from functools import lru_cache

from irlx.diagnostics import SourceText
from irlx.language.highlight import Kind, pieces

__all__ = ["painted_line"]

_MOST = 300_000
"""Characters of the longest text that is coloured: about half a second."""
_PLAIN = "\x1b[0m"
_KEYWORD, _NAMED, _TEXT, _REMARK = "\x1b[94m", "\x1b[36m", "\x1b[32m", "\x1b[2m"
_COLOURS = {
    Kind.COMMENT: _REMARK,
    Kind.INSTRUCTION: _REMARK,
    Kind.DECLARATION: _KEYWORD,
    Kind.CONTROL: _KEYWORD,
    Kind.MOTION: _KEYWORD,
    Kind.REDUNDANCY: _KEYWORD,
    Kind.WORD_OPERATOR: _KEYWORD,
    Kind.CONSTANT: _KEYWORD,
    Kind.STRING: _TEXT,
    Kind.TYPE: _NAMED,
    Kind.FUNCTION: _NAMED,
    Kind.PROCEDURE: _NAMED,
    Kind.SYSTEM_VARIABLE: _NAMED,
}
"""Of few kinds: an excerpt is one line, in which the mark below has to stand out."""


def painted_line(source: SourceText, line: int) -> str:
    """Line of a program (counted from 1) without its end, coloured by escape sequences."""
    if len(source.text) > _MOST:
        return source.line_text(line)
    return _painted_lines(source)[line - 1].rstrip("\r")


@lru_cache(maxsize=4)
def _painted_lines(source: SourceText) -> list[str]:
    """All lines of a text: what a line is depends on those before it."""
    lines = [""]
    for kind, text in pieces(source.text):
        first, *others = (_painted(part, _COLOURS.get(kind)) for part in text.split("\n"))
        lines[-1] += first
        lines += others
    return lines


def _painted(text: str, colour: str | None) -> str:
    return f"{colour}{text}{_PLAIN}" if colour and text else text
