"""Tokens and sets of terminals in people's words."""

from __future__ import annotations

from collections.abc import Sequence, Set

from irlx.language.keywords import NAMES_TOO
from irlx.language.parsing.machine import END
from irlx.language.token import Token

__all__ = ["construct", "expected_words", "found_words", "sign_or_word"]

_SIGNS = {
    "SEMICOLON": "';'",
    "COLON": "':'",
    "COMMA": "','",
    "DOT": "'.'",
    "RANGE": "'..'",
    "ASSIGN": "':='",
    "EQUAL": "'='",
    "LEFT_PAREN": "'('",
    "RIGHT_PAREN": "')'",
    "LEFT_BRACKET": "'['",
    "RIGHT_BRACKET": "']'",
}
_OPERATORS = frozenset(
    [
        "PLUS",
        "MINUS",
        "STAR",
        "SLASH",
        "COMPOSE",
        "EQUAL",
        "UNEQUAL",
        "LESS",
        "GREATER",
        "LESS_EQUAL",
        "GREATER_EQUAL",
        "AND",
        "OR",
        "EXOR",
        "DIV",
        "MOD",
        "NOT",
    ]
)
_VALUES = frozenset({"INT", "REAL", "STRING", "TRUE", "FALSE", "LEFT_PAREN", "PLUS", "MINUS", "NOT", "NAME"})
_MANY = 5


def found_words(token: Token) -> str:
    """What stands there, for example ``the keyword ENDIF``."""
    if token.type == END:
        return "the end of the file"
    if token.type == "NAME":
        return f"the name '{token}'"
    if token.type in ("INT", "REAL"):
        return f"the number {token}"
    if token.type == "STRING":
        return f"the text {token}" if len(token) < 30 else "a text"
    if token[0].isalpha():
        return f"the keyword {token.type}"
    return f"'{token}'"


def sign_or_word(kind: str) -> str:
    """A terminal as a program writes it, for example ``':'`` or ``OF``."""
    return _SIGNS.get(kind, kind)


def expected_words(kinds: Set[str]) -> str:
    """What would fit, for example ``a value`` or ``',' or ')'``."""
    if kinds == {"EQUAL"}:
        return "'='"
    if {"ASSIGN", "SEMICOLON", "LEFT_PAREN"} <= kinds:
        return "':=', '(' or ';'"
    if {"ASSIGN", "DOT"} <= kinds:
        return "':='"
    if "MOVE" in kinds and "IF" in kinds:
        return "a statement"
    if "INT" in kinds and "NAME" in kinds:
        others = sorted(_SIGNS[kind] for kind in kinds - _VALUES if kind in _SIGNS)
        return " or ".join(["a value", *others]) if len(others) <= 1 else "a value"
    if "VAR" in kinds and ("BEGIN" in kinds or "ENDMODULE" in kinds):
        return "a declaration or BEGIN" if "BEGIN" in kinds else "a declaration or ENDMODULE"
    words = []
    if "NAME" in kinds:
        words.append("a type" if "ARRAY" in kinds else "a name")
        kinds = kinds - NAMES_TOO - {"ARRAY", "RECORD"}
    signs = [sign for kind, sign in _SIGNS.items() if kind in kinds and kind not in _OPERATORS]
    keywords = sorted(k for k in kinds if k not in _SIGNS and k not in _OPERATORS and k not in ("NAME", END))
    words += _telling(signs, keywords)
    if not words and END in kinds:
        words = ["the end of the file"]
    return _joined(words[:_MANY]) if words else "something else"


def _telling(signs: list[str], keywords: list[str]) -> list[str]:
    """Signs and keywords worth naming; what closes comes before what goes on."""
    if keywords and len(keywords) <= _MANY:
        # An index, a call or a field may always follow a name; that helps nobody here.
        return keywords + [sign for sign in signs if sign in ("';'", "','", "')'", "']'", "':='")]
    closing = [sign for sign in signs if sign in ("';'", "','", "')'", "']'", "'..'", "':'")]
    return closing or signs


def _joined(words: list[str]) -> str:
    return words[0] if len(words) == 1 else ", ".join(words[:-1]) + " or " + words[-1]


def construct(tokens: Sequence[Token]) -> str:
    """What the tokens since the last boundary are, for example ``the MOVE`` or ``the assignment``."""
    if not tokens:
        return "the statement"
    first = tokens[0]
    if first.type == "DATALIST" and len(tokens) > 1 and tokens[1].type in NAMES_TOO | {"NAME"}:
        return "the DATALIST"
    if first.type == "NAME" or first.type in NAMES_TOO:
        kinds = {token.type for token in tokens}
        if "ASSIGN" in kinds and "COLON" not in kinds:
            return "the assignment"
        if "COLON" in kinds or "EQUAL" in kinds:
            return "the declaration"
        return f"the call of '{first}'"
    if first.type in ("STANDARD_IN", "STANDARD_OUT", "ARRAY", "INPUT", "OUTPUT", "DIGITAL", "ANALOG"):
        return "the declaration"
    return f"the {tokens[-1].type}" if tokens[-1].type.startswith("END") else f"the {first.type}"
