"""Values of a running program: Python's own for simple types, immutable structures for the others.

Values never change in place, so assignment copies without copying: value semantics for free.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from irlx.interpreter.types import Array, Record, Simple, Type


class Unset:
    """The value of a variable that nothing was assigned to."""

    def __repr__(self) -> str:
        return "UNSET"


UNSET = Unset()


@dataclass(frozen=True)
class RecordValue:
    """One value for each field of `type`."""

    type: Record
    values: tuple[Value, ...]

    def field(self, key: str) -> Value:
        """Value of a field by its casefolded name."""
        return self.values[self.type.index[key]]

    def reals(self) -> tuple[float, ...]:
        """The fields of a record of numbers as floats."""
        return tuple(float(value) for value in self.values if isinstance(value, int | float))


@dataclass(frozen=True)
class ArrayValue:
    """Elements of an array, the last index running fastest."""

    type: Array
    values: tuple[Value, ...]


Value: TypeAlias = bool | int | float | str | RecordValue | ArrayValue | Unset


def unset_value(type: Type) -> Value:
    """Value of a fresh variable: structures exist, their leaves are unset."""
    if isinstance(type, Simple):
        return UNSET
    if isinstance(type, Record):
        return RecordValue(type, tuple(unset_value(field) for _, field in type.fields))
    return ArrayValue(type, (unset_value(type.element),) * type.size)


def is_set(value: Value) -> bool:
    """Whether a value, and every part of it, has been assigned."""
    if isinstance(value, RecordValue | ArrayValue):
        return all(is_set(part) for part in value.values)
    return not isinstance(value, Unset)


def type_name(value: Value) -> str:
    """Name of a value's type as messages give it."""
    if isinstance(value, RecordValue | ArrayValue):
        return value.type.name
    if isinstance(value, Unset):
        return "no value"
    names = {bool: "BOOL", int: "INT", float: "REAL", str: "STRING"}
    return names[type(value)]
