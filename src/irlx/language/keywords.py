"""The keyword table, read from the grammar's ``%declare`` lines, and words with a second use as names."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import lru_cache
from types import MappingProxyType

from irlx.language.grammar_text import grammar_text

__all__ = ["NAMES_TOO", "is_name", "keyword_table"]

# The grammar's rule `name` admits these; a test compares the two.
NAMES_TOO = frozenset({"AT", "FRAME", "SEC", "STEP", "TIMEOUT", "TO", "DATALIST", "SPECIFICATION"})

_NAME = re.compile(r"[^\W\d_]\w*")
_DECLARE = re.compile(r"^%declare\s+(.*)$", re.MULTILINE)


@lru_cache(maxsize=1)
def keyword_table() -> Mapping[str, str]:
    """Casefolded keyword to its terminal, for example 'endif' to ENDIF."""
    words = " ".join(_DECLARE.findall(grammar_text())).split()
    return MappingProxyType({word.casefold(): word for word in words})


def is_name(text: str) -> bool:
    """Whether a program can write a text (NFC) as a name: a letter, then letters, digits or _; no keyword."""
    word = keyword_table().get(text.casefold())
    return _NAME.fullmatch(text) is not None and (word is None or word in NAMES_TOO)
