"""Making a value fit the type that is expected where it stands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Any

from irlx.diagnostics import SourceText, Span
from irlx.interpreter.compiled import Compiled, constant, failing
from irlx.interpreter.errors import fail
from irlx.interpreter.quaternion import norm
from irlx.interpreter.types import CHAR, INT, ORIENTATION, REAL, STRING, Array, Record, Type
from irlx.interpreter.values import ArrayValue, RecordValue, Value
from irlx.language.ranges import INT_LIMIT, INT_RANGE, REAL_RANGE, UNIT_LENGTH


@dataclass(frozen=True)
class Where:
    """Source and span that a message about a value points to."""

    source: SourceText
    span: Span


def fit(found: Compiled, expected: Type, where: Where) -> Compiled:
    """The expression as one of the expected type; fails with IRL222 where the types differ.

    INT becomes REAL, CHAR becomes STRING, and a literal text of one character CHAR.
    """
    if found.type is None or found.type == expected:
        return found
    run = found.run
    if expected == REAL and found.type == INT:
        if found.constant:
            return constant(REAL, float(run([])))
        return Compiled(REAL, lambda frame: float(run(frame)))
    if expected == STRING and found.type == CHAR:
        return Compiled(STRING, run, constant=found.constant)
    if expected == CHAR and len(found.text or "") == 1:
        return Compiled(CHAR, run, constant=True, text=found.text)
    data = {"expected": expected.name, "found": found.type.name}
    return failing(fail("IRL222", where.source, where.span, **data), (found,))


def whole_number(value: int, what: str, where: Where) -> int:
    """The value where it fits INT. Raises InterpreterError, IRL503."""
    if not -INT_LIMIT <= value < INT_LIMIT:
        raise fail("IRL503", where.source, where.span, what=what, type="INT", range=INT_RANGE)
    return value


def finite(value: Any, where: Where) -> Any:
    """The value where all its numbers are finite. Raises InterpreterError, IRL503."""
    if isinstance(value, float) and not isfinite(value):
        raise fail("IRL503", where.source, where.span, what="the result", type="REAL", range=REAL_RANGE)
    if isinstance(value, RecordValue):
        for part in value.values:
            finite(part, where)
    return value


def parts_needed(type: Type) -> int:
    """Number of values that an aggregate of a type takes; 0 for types that have none."""
    if isinstance(type, Record):
        return len(type.fields)
    return type.size if isinstance(type, Array) else 0


def assemble(type: Record | Array, parts: Sequence[Value], where: Where) -> Value:
    """Structured value of as many parts as it needs, which already fit.

    Raises InterpreterError, IRL230, for an orientation that is no unit quaternion.
    """
    if isinstance(type, Array):
        return ArrayValue(type, list(parts))
    value = RecordValue(type, tuple(parts))
    if type == ORIENTATION:
        return unit_orientation(value, where)
    return value


def unit_orientation(value: RecordValue, where: Where) -> RecordValue:
    """The orientation with its length made exactly 1; quaternions typed with 6 digits are meant so."""
    quaternion = value.reals()
    length = norm(quaternion)
    if abs(length - 1.0) > UNIT_LENGTH:
        raise fail("IRL230", where.source, where.span, length=f"{length:.9g}")
    return RecordValue(ORIENTATION, tuple(part / length for part in quaternion))


def part_type(type: Record | Array, index: int) -> Type:
    """Type of a part by its position; the last one's for positions beyond (the count is judged later)."""
    if isinstance(type, Array):
        return type.element
    return type.fields[min(index, len(type.fields) - 1)][1] if type.fields else REAL
