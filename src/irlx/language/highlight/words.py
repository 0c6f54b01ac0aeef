"""Kinds of keywords and signs, read from the grammar, like the keywords."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import lru_cache
from types import MappingProxyType

from irlx.language.grammar_text import grammar_text
from irlx.language.highlight.kind import Kind
from irlx.language.keywords import keyword_table
from irlx.language.terminals import terminals

__all__ = ["keyword_kinds", "sign_kinds"]

_SECTION = re.compile(r"^// ---- (.*)$", re.MULTILINE)
_OPERATION = re.compile(r"^.*-> (?:binary|unary)$", re.MULTILINE)
_LITERAL = re.compile(r"^bool_literal: (.*)$", re.MULTILINE)
_SECTIONS = (
    ("statements", Kind.CONTROL),
    ("program parts", Kind.DECLARATION),
    ("switches", Kind.REDUNDANCY),
    ("motion", Kind.MOTION),
)
"""Beginnings of the grammar's headings; of a word that several sections use the first one here counts."""


@lru_cache(maxsize=1)
def keyword_kinds() -> Mapping[str, Kind]:
    """Kind of each keyword, by its terminal: that of the section of the grammar whose rules use it."""
    words = set(keyword_table().values())
    kinds: dict[str, Kind] = dict.fromkeys(_words_in(_LITERAL, words), Kind.CONSTANT)
    kinds |= dict.fromkeys(_words_in(_OPERATION, words), Kind.WORD_OPERATOR)
    headings = _SECTION.split(grammar_text())
    sections = list(zip(headings[1::2], headings[2::2], strict=True))
    for beginning, kind in _SECTIONS:
        for heading, rules in sections:
            if heading.startswith(beginning):
                for word in re.findall(r"\b[A-Z_]+\b", rules):
                    if word in words:
                        kinds.setdefault(word, kind)
    return MappingProxyType(kinds)


def _words_in(pattern: re.Pattern[str], words: set[str]) -> list[str]:
    text = " ".join(match[0] for match in pattern.finditer(grammar_text()))
    return [word for word in re.findall(r"\b[A-Z_]+\b", text) if word in words]


@lru_cache(maxsize=1)
def sign_kinds() -> Mapping[str, Kind]:
    """Kind of each sign: an operator where an operation of the grammar uses it, or where it sets a value."""
    text = " ".join(match[0] for match in _OPERATION.finditer(grammar_text()))
    operators = {*re.findall(r'"([^"]+)"', text), ":=", ".."}
    kinds = {one.pattern: Kind.PUNCTUATION for one in terminals() if one.is_sign}
    return MappingProxyType(
        {sign: Kind.OPERATOR if sign in operators else kind for sign, kind in kinds.items()}
    )
