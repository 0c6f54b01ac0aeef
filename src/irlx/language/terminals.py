"""The terminals of the grammar, read from its text."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import NamedTuple

from irlx.language.grammar_text import grammar_text

__all__ = ["Terminal", "terminals"]

_TERMINAL = re.compile(r'^([A-Z_]+)(?:\.(-?\d+))?: (?:/(.+)/|"(.+)")$', re.MULTILINE)


class Terminal(NamedTuple):
    """One terminal of the grammar: its name, its pattern, and whether that is a sign, not an expression."""

    name: str
    pattern: str
    is_sign: bool


@lru_cache(maxsize=1)
def terminals() -> tuple[Terminal, ...]:
    """All terminals but keywords, those that are tried earlier first: by priority, then longer signs."""
    found = []
    for name, priority, pattern, sign in _TERMINAL.findall(grammar_text()):
        found.append((-int(priority or 0), -len(sign), Terminal(name, pattern or sign, bool(sign))))
    return tuple(terminal for _, _, terminal in sorted(found, key=lambda each: each[:2]))
