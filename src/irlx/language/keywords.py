"""The keyword table, read from the grammar's ``%declare`` lines, and words with a second use as names."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import lru_cache
from types import MappingProxyType

from irlx.language.grammar_text import grammar_text

__all__ = ["NAMES_TOO", "keyword_table"]

# The grammar's rule `name` admits these; a test compares the two.
NAMES_TOO = frozenset({"AT", "SEC", "STEP", "TIMEOUT", "TO", "DATALIST", "SPECIFICATION"})

_DECLARE = re.compile(r"^%declare\s+(.*)$", re.MULTILINE)


@lru_cache(maxsize=1)
def keyword_table() -> Mapping[str, str]:
    """Casefolded keyword to its terminal, for example 'endif' to ENDIF."""
    words = " ".join(_DECLARE.findall(grammar_text())).split()
    return MappingProxyType({word.casefold(): word for word in words})
