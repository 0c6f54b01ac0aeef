"""Values of a running program: Python's own for simple types, structures for the others.

Records never change in place. Arrays do, as long as only one variable has them: whoever reads one as a
whole marks it as shared, and a shared one is copied before it changes. Assignment copies without
copying: value semantics for free.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
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

    def reals(self) -> tuple[float, ...]:
        """The fields of a record of numbers as floats."""
        return tuple(float(value) for value in self.values if isinstance(value, int | float))


@dataclass
class ArrayValue:
    """Elements of an array, the last index running fastest; `shared` ones must not change any more.

    `complete` ones were seen to have values everywhere: what has one never loses it.
    """

    type: Array
    values: list[Value]
    shared: bool = field(default=False, compare=False)
    complete: bool = field(default=False, compare=False)

    def unshared(self) -> ArrayValue:
        """This array where it may change, else a copy that may."""
        if not self.shared:
            return self
        if has_arrays(self.type.element):
            for value in self.values:
                share(value)
        return ArrayValue(self.type, self.values.copy(), complete=self.complete)


Value: TypeAlias = bool | int | float | str | RecordValue | ArrayValue | Unset


@cache
def has_arrays(type: Type) -> bool:
    """Whether values of a type are arrays or hold some."""
    if isinstance(type, Record):
        return any(has_arrays(part) for _, part in type.fields)
    return isinstance(type, Array)


def share(value: Value) -> None:
    """Mark the arrays of a value: whoever has it may rely on it from now on."""
    if isinstance(value, ArrayValue):
        value.shared = True
    elif isinstance(value, RecordValue):
        for part, (_, type) in zip(value.values, value.type.fields, strict=True):
            if not isinstance(type, Simple):
                share(part)


def replaced(value: Value, steps: Sequence[int], new: Value) -> Value:
    """The value with the part at `steps` replaced; arrays that may change do so in place."""
    if not steps:
        return new
    if isinstance(value, ArrayValue):
        array = value.unshared()
        array.values[steps[0]] = replaced(array.values[steps[0]], steps[1:], new)
        return array
    if not isinstance(value, RecordValue):
        raise TypeError("only structures have parts")
    at = steps[0]
    part = replaced(value.values[at], steps[1:], new)
    return RecordValue(value.type, (*value.values[:at], part, *value.values[at + 1 :]))


def unset_value(type: Type) -> Value:
    """Value of a fresh variable: structures exist, their leaves are unset; its arrays are shared."""
    if isinstance(type, Simple):
        return UNSET
    if isinstance(type, Record):
        return RecordValue(type, tuple(unset_value(part) for _, part in type.fields))
    return ArrayValue(type, [unset_value(type.element)] * type.size, shared=True)


def is_set(value: Value) -> bool:
    """Whether a value, and every part of it, has been assigned."""
    if isinstance(value, RecordValue):
        return all(map(is_set, value.values))
    if isinstance(value, ArrayValue):
        value.complete = value.complete or all(map(is_set, value.values))
        return value.complete
    return value is not UNSET


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
