"""Making a value fit the type that is expected where it stands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite

from irlx.diagnostics import SourceText, Span
from irlx.interpreter.errors import fail
from irlx.interpreter.quaternion import norm
from irlx.interpreter.types import BOOL, INT, ORIENTATION, REAL, STRING, Array, Record, Type
from irlx.interpreter.values import ArrayValue, RecordValue, Value, type_name

_UNIT_LENGTH = 1e-6
_INT_LIMIT = 2**63
_INT_RANGE = "INT holds the whole numbers from -2^63 to 2^63 - 1"
_REAL_RANGE = "REAL holds numbers up to 1.8E308"


@dataclass(frozen=True)
class Where:
    """Source and span that a message about a value points to."""

    source: SourceText
    span: Span


def fit(value: Value, expected: Type, where: Where) -> Value:
    """The value as one of the expected type: INT becomes REAL, records of like fields change their name.

    Raises InterpreterError: IRL222 where the types differ.
    """
    if expected is REAL and _is_number(value):
        return float(value)  # type: ignore[arg-type]
    if expected is INT and isinstance(value, int) and not isinstance(value, bool):
        return value
    if (expected is BOOL and isinstance(value, bool)) or (expected is STRING and isinstance(value, str)):
        return value
    if isinstance(expected, Record) and isinstance(value, RecordValue) and value.type == expected:
        return value
    if isinstance(expected, Array) and isinstance(value, ArrayValue) and value.type == expected:
        return value
    raise fail("IRL222", where.source, where.span, expected=expected.name, found=type_name(value))


def count(number: int, noun: str, nouns: str = "") -> str:
    """A number of things in words: ``1 value``, ``2 values``."""
    return f"{number} {noun}" if number == 1 else f"{number} {nouns or noun + 's'}"


def _is_number(value: Value) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def whole_number(value: int, what: str, where: Where) -> int:
    """The value where it fits INT. Raises InterpreterError, IRL503."""
    if not -_INT_LIMIT <= value < _INT_LIMIT:
        raise fail("IRL503", where.source, where.span, what=what, type="INT", range=_INT_RANGE)
    return value


def finite(value: Value, where: Where) -> Value:
    """The value where all its numbers are finite. Raises InterpreterError, IRL503."""
    if isinstance(value, float) and not isfinite(value):
        raise fail("IRL503", where.source, where.span, what="the result", type="REAL", range=_REAL_RANGE)
    if isinstance(value, RecordValue):
        for part in value.values:
            finite(part, where)
    return value


def assemble(type: Record | Array, parts: Sequence[Value], where: Where) -> Value:
    """Structured value of parts that already fit. Raises InterpreterError: IRL223 for a wrong number,
    IRL230 for an orientation that is no unit quaternion."""
    expected = len(type.fields) if isinstance(type, Record) else type.size
    if len(parts) != expected:
        data = {"type": type.name, "expected": count(expected, "value"), "found": len(parts)}
        raise fail("IRL223", where.source, where.span, **data)
    if isinstance(type, Array):
        return ArrayValue(type, tuple(parts))
    value = RecordValue(type, tuple(parts))
    if type == ORIENTATION:
        return unit_orientation(value, where)
    return value


def unit_orientation(value: RecordValue, where: Where) -> RecordValue:
    """The orientation with its length made exactly 1; quaternions typed with 6 digits are meant so."""
    quaternion = value.reals()
    length = norm(quaternion)
    if abs(length - 1.0) > _UNIT_LENGTH:
        raise fail("IRL230", where.source, where.span, length=f"{length:.9g}")
    return RecordValue(ORIENTATION, tuple(part / length for part in quaternion))


def part_type(type: Record | Array, index: int) -> Type:
    """Type of a part by its position; the last one's for positions beyond (the count is judged later)."""
    if isinstance(type, Array):
        return type.element
    return type.fields[min(index, len(type.fields) - 1)][1] if type.fields else REAL
