"""Words and signs of a text, as the lexer gives them and the parser takes them."""

from __future__ import annotations

__all__ = ["Token"]


class Token(str):
    """The text of one word, sign or literal; `type` is its terminal, offsets are those of the text.

    `line` and `column` count from 1 and are None where nothing in the text stands for the token.
    """

    __slots__ = ("column", "end_pos", "line", "start_pos", "type")

    type: str
    start_pos: int
    end_pos: int
    line: int | None
    column: int | None

    def __new__(
        cls,
        type: str,
        text: str,
        start_pos: int = 0,
        end_pos: int = 0,
        line: int | None = None,
        column: int | None = None,
    ) -> Token:
        """A token of a terminal; what the text lacks has its place where it would stand."""
        token = str.__new__(cls, text)
        token.type = type
        token.start_pos = start_pos
        token.end_pos = end_pos
        token.line = line
        token.column = column
        return token
