"""Types of the language: simple types, records and arrays, and which of them fit where."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from typing import TypeAlias


@dataclass(frozen=True)
class Simple:
    """A type without parts, such as INT or STRING."""

    name: str


@dataclass(frozen=True)
class Record:
    """A record type: names of its fields as declared, and their types.

    `pattern` belongs to a type with a field for each joint whose robot is not known yet: ``A{}`` stands for
    A1, A2 and so on, and `fields` is empty.
    """

    name: str
    fields: tuple[tuple[str, Type], ...]
    pattern: str = ""

    @cached_property
    def index(self) -> Mapping[str, int]:
        """Position of a field by its casefolded name."""
        return {name.casefold(): position for position, (name, _) in enumerate(self.fields)}


Bounds: TypeAlias = tuple[int, int]

ANY_BOUNDS: Bounds = (1, 0)
"""Bounds of a dimension that only a run tells; no type has an empty range otherwise."""


@dataclass(frozen=True)
class Array:
    """An array type: lowest and highest index of each dimension, type of the elements."""

    ranges: tuple[Bounds, ...]
    element: Type

    @cached_property
    def name(self) -> str:
        """The type as a program would write it."""
        ranges = ", ".join(
            "?" if bounds == ANY_BOUNDS else f"{bounds[0]}..{bounds[1]}" for bounds in self.ranges
        )
        return f"ARRAY [{ranges}] OF {self.element.name}"

    @cached_property
    def size(self) -> int:
        """Number of elements; 0 where only a run tells."""
        product = 1
        for low, high in self.ranges:
            product *= high - low + 1
        return product


Type: TypeAlias = Simple | Record | Array

INT, REAL, BOOL, STRING = Simple("INT"), Simple("REAL"), Simple("BOOL"), Simple("STRING")
CHAR, FILE, SEMAPHORE = Simple("CHAR"), Simple("FILE"), Simple("SEMAPHORE")

UNKNOWN = Simple("an unknown type")
"""Type of what is wrong already or cannot be known: it fits everywhere, so that no mistake is told twice."""


def is_number(type: Type) -> bool:
    """Whether a type is INT or REAL."""
    return type is INT or type is REAL


@cache
def holds_files(type: Type) -> bool:
    """Whether a type is FILE or has parts of it: such values are not copied."""
    if isinstance(type, Record):
        return any(holds_files(part) for _, part in type.fields)
    return holds_files(type.element) if isinstance(type, Array) else type is FILE


def same_type(found: Type, expected: Type) -> bool:
    """Whether two types are the same, as far as they are known."""
    if found is expected or found is UNKNOWN or expected is UNKNOWN:
        return True
    if isinstance(found, Record) and isinstance(expected, Record):
        return found.name == expected.name and _same_fields(found, expected)
    if isinstance(found, Array) and isinstance(expected, Array):
        return _same_ranges(found, expected) and same_type(found.element, expected.element)
    return found == expected


def _same_fields(found: Record, expected: Record) -> bool:
    if found.pattern or expected.pattern or found.fields is expected.fields:
        return True
    if len(found.fields) != len(expected.fields):
        return False
    pairs = zip(found.fields, expected.fields, strict=True)
    return all(mine[0] == other[0] and same_type(mine[1], other[1]) for mine, other in pairs)


def _same_ranges(found: Array, expected: Array) -> bool:
    if len(found.ranges) != len(expected.ranges):
        return False
    pairs = zip(found.ranges, expected.ranges, strict=True)
    return all(mine == other or ANY_BOUNDS in (mine, other) for mine, other in pairs)


@cache
def leaves(type: Type) -> int:
    """Number of simple values that a value of a type holds; 0 where only a run tells."""
    if isinstance(type, Record):
        return sum(leaves(part) for _, part in type.fields)
    return type.size * max(leaves(type.element), 1) if isinstance(type, Array) else 1


def fits(found: Type, expected: Type) -> bool:
    """Whether a value of type `found` may stand where `expected` is: INT becomes REAL and CHAR STRING."""
    becomes = (found is INT and expected is REAL) or (found is CHAR and expected is STRING)
    return found is expected or becomes or same_type(found, expected)
