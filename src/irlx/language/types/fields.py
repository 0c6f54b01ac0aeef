"""Fields of records, whose names may hold dots: which field a dotted path means."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache

from irlx.language.types.model import REAL, Record, Type


def longest_field(record: Record, keys: Sequence[str]) -> tuple[Type, int] | None:
    """Type of the longest field that casefolded words joined by dots begin with, and how many it uses."""
    for used in range(len(keys), 0, -1):
        key = keys[0] if used == 1 else ".".join(keys[:used])
        if record.pattern:
            if _pattern(record.pattern).fullmatch(key):
                return REAL, used
        else:
            position = record.index.get(key)
            if position is not None:
                return record.fields[position][1], used
    return None


def field_names(record: Record) -> list[str]:
    """Names of the fields to suggest from; a joint type of an unknown robot gives those of ten joints."""
    if record.pattern:
        return [record.pattern.format(number) for number in range(1, 11)]
    return [name for name, _ in record.fields]


@cache
def _pattern(pattern: str) -> re.Pattern[str]:
    return re.compile(re.escape(pattern.casefold()).replace(r"\{\}", "[1-9][0-9]*"))


def ambiguous_field(record: Record, name: str) -> tuple[str, str] | None:
    """Field, and the path inside it, that the dotted field `name` of the same record could also mean."""
    words = name.split(".")
    for used in range(1, len(words)):
        field, rest = ".".join(words[:used]), words[used:]
        position = record.index.get(field.casefold())
        if position is not None and _leads_somewhere(record.fields[position][1], rest):
            return record.fields[position][0], ".".join(rest)
    return None


def _leads_somewhere(type: Type, words: list[str]) -> bool:
    """Whether words joined by dots are a path of fields in a type."""
    if not words:
        return True
    if not isinstance(type, Record):
        return False
    positions = [
        (used, type.index.get(".".join(words[:used]).casefold())) for used in range(1, len(words) + 1)
    ]
    return any(
        position is not None and _leads_somewhere(type.fields[position][1], words[used:])
        for used, position in positions
    )
