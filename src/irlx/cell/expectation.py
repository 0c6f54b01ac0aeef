"""What a cell file may hold at a key, in words of the file instead of pydantic's."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

_WORDS = {
    "string_type": "a text",
    "string_too_short": "a text that is not empty",
    "bool_type": "true or false",
    "literal_error": "{expected}",
    "float_type": "a number",
    "finite_number": "a finite number",
    "greater_than": "a number greater than {gt:g}",
    "greater_than_equal": "a number of at least {ge:g}",
    "less_than_equal": "a number of at most {le:g}",
    "list_type": "a list",
    "too_short": "{min_length} numbers",
    "too_long": "{max_length} numbers",
}
_TABLES = ("model_type", "model_attributes_type", "dict_type")
_COUNTS = {2: "two", 3: "three"}
_MOST_LETTERS = 80


def expectation(fault: Any) -> str:
    """What pydantic's error `fault` expects; own messages of validators stand as they are."""
    kind = fault["type"]
    if kind in _TABLES:
        return "a table"
    if kind == "missing":
        return f"a table with {fault['loc'][-1]}"
    if kind == "too_short" and fault["ctx"]["min_length"] == 1:
        return "one entry at least"
    if kind not in _WORDS:
        return str(fault["msg"])
    if kind == "literal_error" and "," in fault["ctx"]["expected"]:
        return f"one of {fault['ctx']['expected']}"
    data = {name: _COUNTS.get(value, value) if "length" in name else value for name, value in _data(fault)}
    return _WORDS[kind].format_map(data)


def _data(fault: Any) -> list[tuple[str, Any]]:
    return list(fault.get("ctx", {}).items())


def as_written(value: object) -> str:
    """A value of a TOML file as the file has it, its beginning where it is long."""
    text = _text(value)
    return text if len(text) <= _MOST_LETTERS else f"{text[:_MOST_LETTERS]}..."


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return f"[{', '.join(_text(item) for item in value)}]"
    if isinstance(value, Mapping):
        return "a table"
    return repr(value) if isinstance(value, str) else str(value)
