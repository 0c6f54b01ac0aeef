"""Unary and binary operators by the types of their operands; AND, OR short-circuit in the compiler."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from math import isfinite
from typing import Any, TypeAlias

from irlx.interpreter.code import Frame
from irlx.interpreter.compiled import Compiled, Run, failing, folded
from irlx.interpreter.conversion import Where, finite, whole_number
from irlx.interpreter.errors import fail
from irlx.interpreter.functions import (
    compose,
    orientation,
    parts_of,
    pose,
    position,
    quaternion_of,
    vector_of,
)
from irlx.interpreter.quaternion import Vector, multiply, rotate
from irlx.interpreter.types import BOOL, CHAR, INT, ORIENTATION, POSE, POSITION, REAL, STRING, Type
from irlx.interpreter.values import RecordValue
from irlx.language.ranges import INT_LIMIT

Apply: TypeAlias = "Callable[[Any, Any], Any]"

LONGEST_TEXT = 1_000_000
"""Characters that a text may have."""

_NUMBERS = (INT, REAL)
_TEXTS = (STRING, CHAR)
_COMPARISONS: dict[str, Apply] = {
    "=": operator.eq,
    "<>": operator.ne,
    "<": operator.lt,
    ">": operator.gt,
    "<=": operator.le,
    ">=": operator.ge,
}
_ARITHMETIC: dict[str, Apply] = {"+": operator.add, "-": operator.sub, "*": operator.mul}


def unary(op: str, operand: Compiled, where: Where) -> Compiled:
    """Sign or NOT; fails with IRL227 for operands it is not defined for."""
    run, type = operand.run, operand.type
    if op == "NOT" and type == BOOL:
        return folded(BOOL, lambda frame: not run(frame), operand)
    if op == "+" and type in _NUMBERS:
        return operand
    if op == "-" and type == REAL:
        return folded(REAL, lambda frame: -run(frame), operand)
    if op == "-" and type == INT:
        return folded(INT, _whole(lambda frame: -run(frame), where), operand)
    data = {"op": op, "operands": type.name if type else "no value"}
    return failing(fail("IRL227", where.source, where.span, **data), (operand,))


def binary(op: str, left: Compiled, right: Compiled, where: Where) -> Compiled:
    """Arithmetic, comparison, composition; fails with IRL227, when run with IRL502, IRL503, IRL512."""
    if left.type is None or right.type is None:
        raise TypeError("operands without a value are told before")
    found = _of_types(op, left, right, where)
    if found is None:
        operands = f"{left.type.name} and {right.type.name}"
        return failing(fail("IRL227", where.source, where.span, op=op, operands=operands), (left, right))
    return folded(*found, left, right)


def _of_types(op: str, left: Compiled, right: Compiled, where: Where) -> tuple[Type, Run] | None:
    a, b = left.run, right.run
    if left.type in _NUMBERS and right.type in _NUMBERS:
        return _of_numbers(op, left, right, where)
    if op in _COMPARISONS and _comparable(op, left, right):
        return BOOL, _applied(_COMPARISONS[op], a, b)
    if op == "+" and left.type in _TEXTS and right.type in _TEXTS:
        return STRING, _joined(a, b, where)
    if op == "EXOR" and left.type == BOOL and right.type == BOOL:
        return BOOL, _applied(operator.is_not, a, b)
    if op == "/" and left.type == POSITION and right.type in _NUMBERS:
        return POSITION, _finite(_applied(_divided, a, _divisor(b, where)), where)
    geometric = _GEOMETRIC.get((op, _kind(left.type), _kind(right.type)))
    if geometric is None:
        return None
    return geometric[0], _finite(_applied(geometric[1], a, b), where)


def _comparable(op: str, left: Compiled, right: Compiled) -> bool:
    """Whether values that are no numbers compare; a CHAR does with a literal of one character."""
    if op in ("=", "<>") and (left.type == right.type == BOOL or {left.type, right.type} <= {*_TEXTS}):
        return True
    ordered = all(part.type == CHAR or len(part.text or "") == 1 for part in (left, right))
    return ordered and CHAR in (left.type, right.type)


def _applied(apply: Apply, a: Run, b: Run) -> Run:
    return lambda frame: apply(a(frame), b(frame))


# ---- numbers


def _of_numbers(op: str, left: Compiled, right: Compiled, where: Where) -> tuple[Type, Run] | None:
    a, b = left.run, right.run
    if op in _COMPARISONS:
        return BOOL, _against(_COMPARISONS[op], a, right)
    whole = left.type == INT and right.type == INT
    if op in _ARITHMETIC:
        run = _against(_ARITHMETIC[op], a, right)
        return (INT, _whole(run, where)) if whole else (REAL, _real(run, where))
    if op == "/":
        return REAL, _real(_applied(operator.truediv, a, _divisor(b, where)), where)
    if op in ("DIV", "MOD") and whole:
        apply = quotient if op == "DIV" else remainder
        return INT, _whole(_applied(apply, a, _divisor(b, where)), where)
    return None


def _against(apply: Apply, a: Run, right: Compiled) -> Run:
    """The operator with its right side, which costs nothing where it is constant."""
    if right.constant:
        value = right.run([])
        return lambda frame: apply(a(frame), value)
    return _applied(apply, a, right.run)


def _whole(run: Run, where: Where) -> Run:
    def checked(frame: Frame) -> int:
        value: int = run(frame)
        if -INT_LIMIT <= value < INT_LIMIT:
            return value
        return whole_number(value, "the result", where)

    return checked


def _real(run: Run, where: Where) -> Run:
    def checked(frame: Frame) -> Any:
        value = run(frame)
        return value if isfinite(value) else finite(value, where)

    return checked


def _finite(run: Run, where: Where) -> Run:
    return lambda frame: finite(run(frame), where)


def _divisor(run: Run, where: Where) -> Run:
    def checked(frame: Frame) -> Any:
        value = run(frame)
        if value == 0:
            raise fail("IRL502", where.source, where.span)
        return value

    return checked


def quotient(left: int, right: int) -> int:
    """DIV: towards zero, as in the Pascal family; Python's own // rounds down."""
    return abs(left) // abs(right) * (1 if (left < 0) == (right < 0) else -1)


def remainder(left: int, right: int) -> int:
    """MOD: what DIV leaves, with the sign of `left`."""
    return left - right * quotient(left, right)


# ---- texts


def _joined(a: Run, b: Run, where: Where) -> Run:
    def joined(frame: Frame) -> str:
        left, right = a(frame), b(frame)
        length = len(left) + len(right)
        if length > LONGEST_TEXT:
            raise fail("IRL512", where.source, where.span, length=length, most=f"{LONGEST_TEXT:,}")
        return str(left + right)

    return joined


# ---- geometry


def _kind(type: Type | None) -> str:
    """Name of a type for the table: INT counts as REAL."""
    if type is None:
        return ""
    return REAL.name if type == INT else type.name


def _shifted(at: Vector, by: Vector, sign: float) -> RecordValue:
    return position((at[0] + sign * by[0], at[1] + sign * by[1], at[2] + sign * by[2]))


def _sum(sign: float) -> Apply:
    return lambda a, b: _shifted(vector_of(a), vector_of(b), sign)


def _shifted_pose(sign: float) -> Apply:
    def shifted(a: RecordValue, b: RecordValue) -> RecordValue:
        at, turned = parts_of(a)
        return pose(vector_of(_shifted(at, vector_of(b), sign)), turned)

    return shifted


def _point(a: RecordValue, b: RecordValue) -> RecordValue:
    at, turned = parts_of(a)
    return _shifted(at, rotate(turned, vector_of(b)), 1.0)


def _scaled(value: RecordValue, factor: float) -> RecordValue:
    x, y, z = vector_of(value)
    return position((x * factor, y * factor, z * factor))


def _divided(value: RecordValue, divisor: float) -> RecordValue:
    # Not times 1 / divisor, which is infinite for the smallest divisors even where the quotients are not.
    x, y, z = vector_of(value)
    return position((x / divisor, y / divisor, z / divisor))


_GEOMETRIC: Mapping[tuple[str, str, str], tuple[Type, Apply]] = {
    ("+", "POSITION", "POSITION"): (POSITION, _sum(1.0)),
    ("-", "POSITION", "POSITION"): (POSITION, _sum(-1.0)),
    ("+", "POSE", "POSITION"): (POSE, _shifted_pose(1.0)),
    ("-", "POSE", "POSITION"): (POSE, _shifted_pose(-1.0)),
    ("@", "POSE", "POSE"): (POSE, compose),
    ("@", "POSE", "POSITION"): (POSITION, _point),
    ("@", "ORIENTATION", "ORIENTATION"): (
        ORIENTATION,
        lambda a, b: orientation(multiply(quaternion_of(a), quaternion_of(b))),
    ),
    ("*", "ORIENTATION", "POSITION"): (
        POSITION,
        lambda a, b: position(rotate(quaternion_of(a), vector_of(b))),
    ),
    ("*", "POSITION", "REAL"): (POSITION, lambda a, b: _scaled(a, float(b))),
    ("*", "REAL", "POSITION"): (POSITION, lambda a, b: _scaled(b, float(a))),
}
