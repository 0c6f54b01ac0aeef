"""What names are by what stands before and behind them, and words that are keywords in some places only."""

from __future__ import annotations

from irlx.language.builtins import (
    BARE_FUNCTIONS,
    FUNCTIONS,
    PROCEDURES,
    STANDARD_CHANNELS,
    SYSTEM_VARIABLES,
    TYPES,
    is_port_name,
)
from irlx.language.highlight.kind import Kind
from irlx.language.highlight.words import keyword_kinds
from irlx.language.keywords import NAMES_TOO

__all__ = ["NameKinds"]

_OPERANDS = frozenset({"NAME", "INT", "REAL", "STRING", "TRUE", "FALSE", "RIGHT_PAREN", "RIGHT_BRACKET"})
"""Terminals that may end an operand: behind one there is no name, apart from a parameter."""
_AFTER = {"FRAME": ("IN",), "SPECIFICATION": ("SYSTEM",), "DATALIST": ("", "IMPORT")}
"""What stands before a keyword that may also be a name; the others stand behind an operand."""
_OPENING = frozenset({"LEFT_PAREN", "LEFT_BRACKET"})
_CLOSING = frozenset({"RIGHT_PAREN", "RIGHT_BRACKET"})
_DECLARES = frozenset({"PROGRAM", "MODULE", "DATALIST", "CONST", "TYPE", "VAR", "PROCEDURE", "FUNCTION"})
_DECLARES_AGAIN = frozenset({"ENDPROC", "ENDFCT"})
_SECTIONS = frozenset({"CONST", "TYPE", "VAR", "PROCEDURE", "FUNCTION"})
_BEGINS_STATEMENT = frozenset({"SEMICOLON", "BEGIN", "THEN", "ELSE", "DO", "REPEAT", "COLON", ""})
_TAKES_PARAMETERS = frozenset({"MOVE", "MOVE_INC", "CRITERION"})
_NAMED_PARTS = frozenset({"PROGRAM", "MODULE", "DATALIST", "FROM"})
_CHANNEL_NAMES = frozenset(name.casefold() for name in STANDARD_CHANNELS.values())


class NameKinds:
    """Goes through the terminals of a text that count, and tells of each name what it is there."""

    def __init__(self) -> None:
        self._before = self._earlier = ""
        self._depth = 0
        self._declaring = False
        self._heading = False
        self._section = ""
        self._has_parameters = False

    def name(self, terminal: str, text: str, after: str) -> Kind:
        """Kind of a name, or of a keyword that may also be one, before the terminal `after`."""
        if terminal != "NAME" and self._is_keyword(terminal, after):
            self.passed(terminal)
            return keyword_kinds()[terminal]
        kind = self._by_place(after) or self._by_word(text.casefold(), after)
        self.passed("NAME")
        return kind

    def passed(self, terminal: str) -> None:
        """Go on behind a terminal that is no name."""
        if terminal in _OPENING:
            self._depth += 1
        elif terminal in _CLOSING:
            self._depth = max(0, self._depth - 1)
        elif terminal == "SEMICOLON":
            self._has_parameters = False
            if self._depth == 0:
                self._heading = False
        elif terminal in _TAKES_PARAMETERS:
            self._has_parameters = True
        elif terminal == "BEGIN":
            self._declaring, self._section, self._depth = False, "", 0
        elif terminal in _DECLARES or terminal in _DECLARES_AGAIN:
            self._declare(terminal)
        self._earlier, self._before = self._before, terminal

    def _declare(self, terminal: str) -> None:
        self._declaring = True
        if terminal in ("PROCEDURE", "FUNCTION"):
            self._heading = True
            self._depth = 0
        if not self._heading:
            self._section = terminal if terminal in _SECTIONS else ""

    def _is_keyword(self, terminal: str, after: str) -> bool:
        if terminal in _AFTER:
            return self._before in _AFTER[terminal] and (after == "NAME" or after in NAMES_TOO)
        return self._before in _OPERANDS and after != "ASSIGN"

    def _by_place(self, after: str) -> Kind | None:
        """Kind of a name where its place alone decides."""
        if self._before == "DOT":
            return Kind.FIELD
        if self._before in _NAMED_PARTS:
            return Kind.PART
        if self._before in ("PROCEDURE", "FUNCTION"):
            return Kind.ROUTINE
        if self._before == "GOTO" or (after == "COLON" and self._begins_statement()):
            return Kind.LABEL
        return None

    def _by_word(self, key: str, after: str) -> Kind:
        if after == "ASSIGN" and self._has_parameters:
            return Kind.PARAMETER
        if self._is_type(after):
            return Kind.TYPE if key in TYPES else Kind.OWN_TYPE
        if key in SYSTEM_VARIABLES:
            return Kind.SYSTEM_VARIABLE
        if after == "LEFT_PAREN" or (after == "SEMICOLON" and self._begins_statement()):
            return self._called(key, after)
        if key in BARE_FUNCTIONS and after != "ASSIGN":
            return Kind.FUNCTION
        if key in _CHANNEL_NAMES and self._earlier in ("STANDARD_IN", "STANDARD_OUT"):
            return Kind.CHANNEL
        return Kind.PORT if is_port_name(key) else Kind.NAME

    def _called(self, key: str, after: str) -> Kind:
        if self._begins_statement():
            return Kind.PROCEDURE if key in PROCEDURES else Kind.ROUTINE
        if key in TYPES:
            return Kind.TYPE
        return Kind.FUNCTION if key in FUNCTIONS else Kind.ROUTINE

    def _begins_statement(self) -> bool:
        return not self._declaring and self._depth == 0 and self._before in _BEGINS_STATEMENT

    def _is_type(self, after: str) -> bool:
        if not self._declaring:
            return False
        if after == "COLON" or self._before == "OF":
            return True
        if self._heading:
            return self._before == "COLON" and self._depth == 0
        defines = self._section == "TYPE" and self._depth == 0
        return defines and (after == "EQUAL" or self._before == "EQUAL")
