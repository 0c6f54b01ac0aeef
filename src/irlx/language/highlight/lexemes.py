"""Any text to lexemes, without gap and without fail, by the terminals of the grammar.

The parser's own lexer is not used: it takes a library and its tables to load, and what colours a prompt or a
page must do without. Tests compare the two.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple
from unicodedata import normalize

from irlx.language.keywords import keyword_table
from irlx.language.terminals import terminals

__all__ = ["SPACE", "Lexeme", "lexemes"]

SPACE = "SPACE"
"""What stands between lexemes; no terminal of the grammar."""
_LONGEST_MARKS = 40


class Lexeme(NamedTuple):
    """Name of a terminal, and the text that it takes."""

    terminal: str
    text: str


@lru_cache(maxsize=1)
def _master() -> re.Pattern[str]:
    parts = [rf"(?P<{SPACE}>\s+)"]
    for one in terminals():
        parts.append(f"(?P<{one.name}>{re.escape(one.pattern) if one.is_sign else one.pattern})")
    return re.compile("|".join(parts))


def lexemes(text: str) -> Iterator[Lexeme]:
    """Lexemes of a text; their texts joined are the text again, whatever it is."""
    normal = normalize("NFC", text)
    found = _normal_lexemes(normal)
    yield from found if normal == text else _as_written(found, text)


def _normal_lexemes(text: str) -> Iterator[Lexeme]:
    table = keyword_table()
    for match in _master().finditer(text):
        name, piece = match.lastgroup or "", match[0]
        yield Lexeme(table.get(piece.casefold(), name) if name == "NAME" else name, piece)


def _as_written(found: Iterator[Lexeme], text: str) -> Iterator[Lexeme]:
    """Lexemes of a normalised text with their pieces as they stand in the text itself."""
    start = 0
    for lexeme in found:
        end = start + len(lexeme.text)
        last = min(len(text), start + 4 * len(lexeme.text) + _LONGEST_MARKS)
        while end <= last and normalize("NFC", text[start:end]) != lexeme.text:
            end += 1
        if end > last:
            break
        yield Lexeme(lexeme.terminal, text[start:end])
        start = end
    if start < len(text):
        # Marks that belong to nothing were put in another order.
        yield Lexeme("WRONG_CHARACTER", text[start:])
