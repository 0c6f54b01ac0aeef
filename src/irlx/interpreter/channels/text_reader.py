"""Reading values from a text that comes piece by piece."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from irlx.interpreter.channels.fault import ChannelFault
from irlx.interpreter.operators import LONGEST_TEXT
from irlx.language.ranges import INT_LIMIT

_LONGEST_WORD = 2_000
_SHOWN = 40

_SPACE = re.compile(r"[ \t\r\n\f\v]*")
_BLANKS = re.compile(r"[ \t]*\n?")
_WORD = re.compile(rf"[^\s,;]{{1,{_LONGEST_WORD}}}")
_WHOLE = re.compile(r"[+-]?[0-9]+")
_NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")
_TRUTH = {"TRUE": True, "FALSE": False}


class TextReader:
    """A place in a text; `pull` gives the next piece of it, '' at its end. Lines end with ``\\n`` alone.

    `name` is what messages call the text; lines and columns count from 1.
    """

    def __init__(self, name: str, pull: Callable[[], str]) -> None:
        self.name = name
        self.line = self.column = 1
        self._pull = pull
        self._text, self._at, self._ended = "", 0, False

    # ---- values

    def whole(self) -> int:
        """A whole number. Raises ChannelFault: IRL546 at the end, IRL547 for another text."""
        word = self._word("a whole number", _WHOLE)
        # The digits of far too long a number are not even counted: int() takes its time.
        value = int(word) if len(word.lstrip("+-0")) < 20 else INT_LIMIT
        if not -INT_LIMIT <= value < INT_LIMIT:
            raise self._wrong("a whole number from -2^63 to 2^63 - 1", word)
        self._behind(word)
        return value

    def real(self) -> float:
        """A number, whole or not. Raises ChannelFault: IRL546, IRL547."""
        word = self._word("a number", _NUMBER)
        value = float(word)
        if abs(value) == float("inf"):
            raise self._wrong("a number up to 1.8E308", word)
        self._behind(word)
        return value

    def truth(self) -> bool:
        """TRUE or FALSE in any case. Raises ChannelFault: IRL546, IRL547."""
        word = self._word("TRUE or FALSE", None)
        value = _TRUTH.get(word.upper())
        if value is None:
            raise self._wrong("TRUE or FALSE", word)
        self._behind(word)
        return value

    def character(self) -> str:
        """The next character, whatever it is. Raises ChannelFault, IRL546."""
        if self.at_end():
            raise self._end("a character")
        found = self._text[self._at]
        self._advance(1)
        return found

    def rest_of_line(self) -> str:
        """What is left of the line; its end is taken and left out. Raises ChannelFault: IRL546, IRL512."""
        if self.at_end():
            raise self._end("a text")
        end = self._text.find("\n", self._at)
        while end < 0 and len(self._text) - self._at <= LONGEST_TEXT and self._more():
            end = self._text.find("\n", self._at)
        stop = len(self._text) if end < 0 else end
        if stop - self._at > LONGEST_TEXT:
            raise ChannelFault("IRL512", length=f"more than {LONGEST_TEXT:,}", most=f"{LONGEST_TEXT:,}")
        found = self._text[self._at : stop]
        self._advance(len(found) + (end >= 0))
        return found

    def at_end(self) -> bool:
        """Whether nothing is left, no line end either."""
        while self._at == len(self._text):
            if not self._more():
                return True
        return False

    # ---- the text

    def _more(self) -> bool:
        """Get another piece behind what is there; False at the end."""
        piece = "" if self._ended else self._pull()
        self._ended = not piece
        self._text, self._at = self._text[self._at :] + piece, 0
        return not self._ended

    def _advance(self, count: int) -> None:
        taken = self._text[self._at : self._at + count]
        lines = taken.count("\n")
        self.line += lines
        self.column = len(taken) - taken.rfind("\n") if lines else self.column + count
        self._at += count

    def _take(self, pattern: re.Pattern[str]) -> None:
        """Take what a pattern matches, of pieces to come as well."""
        while True:
            found = pattern.match(self._text, self._at)
            self._advance(found.end() - self._at if found else 0)
            if self._at < len(self._text) or not self._more():
                return

    def _word(self, expected: str, form: re.Pattern[str] | None) -> str:
        """The next word, behind white space, not taken yet. Raises ChannelFault: IRL546, IRL547."""
        self._take(_SPACE)
        if self.at_end():
            raise self._end(expected)
        while True:
            found = _WORD.match(self._text, self._at)
            if found is None or found.end() < len(self._text) or len(found[0]) == _LONGEST_WORD:
                break
            if not self._more():
                break
        word = found[0] if found else self._text[self._at]
        if len(word) == _LONGEST_WORD or (form is not None and form.fullmatch(word) is None):
            raise self._wrong(expected, word)
        return word

    def _behind(self, word: str) -> None:
        """Take a word with the blanks behind it, and the line end where the line has nothing else."""
        self._advance(len(word))
        while True:
            found = _BLANKS.match(self._text, self._at)
            end = found.end() if found else self._at
            line_ends = end > self._at and self._text[end - 1] == "\n"
            self._advance(end - self._at)
            if line_ends or self._at < len(self._text) or not self._more():
                return

    # ---- what is wrong

    def _end(self, expected: str) -> ChannelFault:
        data: dict[str, Any] = {"name": self.name, "line": self.line, "column": self.column}
        return ChannelFault("IRL546", expected=expected, **data)

    def _wrong(self, expected: str, word: str) -> ChannelFault:
        shown = word if len(word) <= _SHOWN else f"{word[:_SHOWN]}.."
        data: dict[str, Any] = {"name": self.name, "line": self.line, "column": self.column}
        return ChannelFault("IRL547", expected=expected, found=f"'{shown}'", **data)
