"""Lexemes to pieces with a kind, names by what stands around them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from irlx.language.comments import speaks_to_irlx
from irlx.language.highlight.kind import Kind
from irlx.language.highlight.lexemes import SPACE, Lexeme, lexemes
from irlx.language.highlight.name_kinds import NameKinds
from irlx.language.highlight.words import keyword_kinds, sign_kinds
from irlx.language.keywords import NAMES_TOO

__all__ = ["Piece", "pieces"]

_TAKEN_OUT = {
    SPACE: Kind.SPACE,
    "COMMENT": Kind.COMMENT,
    "WRONG_CHARACTER": Kind.WRONG,
    "FOREIGN_COMMENT": Kind.WRONG,
    "FOREIGN_SIGN": Kind.WRONG,
    "FOREIGN_QUOTES": Kind.WRONG,
}
"""What stands between the lexemes that count."""
_NUMBERS = {"INT": Kind.INT, "REAL": Kind.REAL}


class Piece(NamedTuple):
    """A piece of a text and its kind."""

    kind: Kind
    text: str


def pieces(text: str) -> Iterator[Piece]:
    """Pieces of any text in order; their texts joined are the text again.

    Kinds are those that the text itself tells, right or wrong as a program: a name is a predefined function
    where it is called, also where the program hides that by a routine of its own. Texts without an end and
    what other languages write are `Kind.WRONG`.
    """
    names = NameKinds()
    waiting: list[Lexeme] = []
    # What a name is depends on the lexeme behind it, so that each waits for the next one that counts.
    for lexeme in lexemes(text):
        if waiting and lexeme.terminal not in _TAKEN_OUT:
            yield from _decided(waiting, lexeme.terminal, names)
            waiting = []
        waiting.append(lexeme)
    if waiting:
        yield from _decided(waiting, "", names)


def _decided(waiting: list[Lexeme], after: str, names: NameKinds) -> Iterator[Piece]:
    """Pieces of a lexeme that counts and of what stands behind it, before a terminal that counts."""
    for lexeme in waiting:
        kind = _TAKEN_OUT.get(lexeme.terminal)
        if kind is Kind.COMMENT and speaks_to_irlx(lexeme.text):
            kind = Kind.INSTRUCTION
        yield Piece(kind or _kind(lexeme, after, names), lexeme.text)


def _kind(lexeme: Lexeme, after: str, names: NameKinds) -> Kind:
    terminal, text = lexeme
    if terminal == "NAME" or terminal in NAMES_TOO:
        return names.name(terminal, text, after)
    names.passed(terminal)
    if terminal == "STRING":
        return Kind.WRONG if text.count(text[0]) % 2 else Kind.STRING
    return _NUMBERS.get(terminal) or keyword_kinds().get(terminal) or sign_kinds()[text]
