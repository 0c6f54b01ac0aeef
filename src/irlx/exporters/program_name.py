"""Names of programs: what a target takes as an identifier, and the nearest one to a file name."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass

_LETTERS_OF = {"ł": "l", "Ł": "L", "ß": "ss", "ø": "o", "Ø": "O", "æ": "ae", "Æ": "AE", "đ": "d", "Đ": "D"}
"""Letters that Unicode does not take apart."""


@dataclass(frozen=True)
class NameRule:
    """Identifiers of a target: ASCII letters, digits and `_`, a letter first, at most `longest` characters.

    `reserved` are words of the language in lower case; `any_case` whether they are reserved in every case.
    """

    longest: int
    reserved: frozenset[str]
    any_case: bool

    def name_from(self, text: str) -> str:
        """The identifier for a text: itself where it is one, otherwise the nearest, always the same.

        Letters lose their accents, what is not allowed becomes `_`, `p_` comes in front of what begins with
        no letter or is reserved, and what is too long loses its end.
        """
        plain = unicodedata.normalize("NFKD", "".join(_LETTERS_OF.get(c, c) for c in text))
        plain = "".join(c for c in plain if not unicodedata.combining(c))
        name = re.sub(r"[^A-Za-z0-9_]", "_", plain)
        if not re.match(r"[A-Za-z]", name) or self._is_reserved(name[: self.longest]):
            name = f"p_{name}"
        return name[: self.longest]

    def _is_reserved(self, name: str) -> bool:
        return (name.lower() if self.any_case else name) in self.reserved
