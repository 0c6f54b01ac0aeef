"""Entries of `[robot.limits]`: a number, a pair, or false; never 0 for false."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite
from typing import Annotated, Literal

from pydantic import Discriminator, PlainValidator, Tag
from pydantic_core import PydanticCustomError

_ENTRY_WORDS = "a number, a pair [lower, upper], or false"
LIST_WORDS = f"{_ENTRY_WORDS}, for each joint"
"""What a list of limits may be, for messages."""


@dataclass(frozen=True)
class LimitEntry:
    """Lower and upper bound of one joint as the file has them (deg | mm), and how it wrote them."""

    lower: float
    upper: float
    written: str

    @property
    def is_negative_number(self) -> bool:
        """Whether the entry is a single number below 0, which bounds nothing."""
        return not self.written.startswith("[") and self.upper < 0.0


def limit_entry(entry: object) -> LimitEntry:
    """Bounds of an entry of the file. Raises PydanticCustomError where it has none of the three forms."""
    # Compared by identity: 0 equals False, and a limit of 0 is a limit.
    if entry is False:
        return LimitEntry(-inf, inf, "false")
    if is_number(entry):
        return LimitEntry(-float(entry), float(entry), f"{entry:.12g}")  # type: ignore[arg-type]
    if isinstance(entry, list) and len(entry) == 2 and all(is_number(bound) for bound in entry):
        lower, upper = entry
        return LimitEntry(float(lower), float(upper), f"[{lower:.12g}, {upper:.12g}]")
    raise PydanticCustomError("limit", _ENTRY_WORDS)


def is_number(value: object) -> bool:
    """Whether a value of a file is a finite number, and no true or false."""
    if not isinstance(value, int | float) or isinstance(value, bool):
        return False
    try:
        return isfinite(value)
    except OverflowError:  # A whole number beyond all floats; TOML does not bound them.
        return False


def _form(given: object) -> str | None:
    if isinstance(given, list):
        return "list"
    return "false" if given is False else None


Limits = Annotated[
    Annotated[list[Annotated[LimitEntry, PlainValidator(limit_entry)]], Tag("list")]
    | Annotated[Literal[False], Tag("false")],
    Discriminator(_form, custom_error_type="limits", custom_error_message=LIST_WORDS),
]
"""Limits of all joints: a list of entries, or false for none."""
