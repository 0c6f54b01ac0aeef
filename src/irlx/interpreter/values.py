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


def unset_part(value: Value) -> str:
    """Selector of the first part without a value, of a value that is not set; '' where none has one."""
    if not isinstance(value, RecordValue | ArrayValue) or _nothing_set(value):
        return ""
    first = next(index for index, part in enumerate(value.values) if not is_set(part))
    return _selector(value.type, first) + unset_part(value.values[first])


def _nothing_set(value: Value) -> bool:
    if isinstance(value, RecordValue | ArrayValue):
        return all(_nothing_set(part) for part in value.values)
    return isinstance(value, Unset)


def _selector(type: Record | Array, position: int) -> str:
    """What a program writes behind a structure for its part at a position."""
    if isinstance(type, Record):
        return f".{type.fields[position][0]}"
    indices = []
    for low, high in reversed(type.ranges):
        position, offset = divmod(position, high - low + 1)
        indices.append(str(low + offset))
    return f"[{', '.join(reversed(indices))}]"


def is_of_type(value: Value, type: Type) -> bool:
    """Whether a value is of a type as it stands, without conversion."""
    if isinstance(value, RecordValue | ArrayValue):
        return value.type == type
    return isinstance(type, Simple) and type_name(value) == type.name


def type_name(value: Value) -> str:
    """Name of a value's type as messages give it."""
    if isinstance(value, RecordValue | ArrayValue):
        return value.type.name
    if isinstance(value, Unset):
        return "no value"
    names = {bool: "BOOL", int: "INT", float: "REAL", str: "STRING"}
    return names[type(value)]
