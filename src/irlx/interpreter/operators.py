"""Unary and binary operators on values that are known; AND, OR short-circuit in the evaluator."""

from __future__ import annotations

from collections.abc import Callable

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
from irlx.interpreter.types import ORIENTATION, POSE, POSITION
from irlx.interpreter.values import RecordValue, Value, type_name

Number = int | float

_COMPARISONS: dict[str, Callable[[Number, Number], bool]] = {
    "=": lambda a, b: a == b,
    "<>": lambda a, b: a != b,
    "<": lambda a, b: a < b,
    ">": lambda a, b: a > b,
    "<=": lambda a, b: a <= b,
    ">=": lambda a, b: a >= b,
}


def is_number(value: Value) -> bool:
    """Whether a value is INT or REAL."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def unary(op: str, value: Value, where: Where) -> Value:
    """Sign or NOT. Raises InterpreterError, IRL227, for operands it is not defined for."""
    if op == "NOT" and isinstance(value, bool):
        return not value
    if op in "+-" and isinstance(value, int | float) and is_number(value):
        if op == "+":
            return value
        return whole_number(-value, "the result", where) if isinstance(value, int) else -value
    raise fail("IRL227", where.source, where.span, op=op, operands=type_name(value))


def binary(op: str, left: Value, right: Value, where: Where) -> Value:
    """Arithmetic, comparison, composition. Raises InterpreterError: IRL227, IRL502, IRL503."""
    result: Value | None = None
    if (
        isinstance(left, int | float)
        and isinstance(right, int | float)
        and is_number(left)
        and is_number(right)
    ):
        result = _compare_or_compute(op, left, right, where)
    elif op in ("=", "<>") and isinstance(left, bool | str) and type(left) is type(right):
        result = (left == right) is (op == "=")
    elif op == "EXOR" and isinstance(left, bool) and isinstance(right, bool):
        result = left is not right
    elif isinstance(left, RecordValue):
        result = _geometric(op, left, right, where)
    elif op == "*" and isinstance(left, int | float) and is_number(left) and isinstance(right, RecordValue):
        result = _scaled(right, float(left)) if right.type == POSITION else None
    if result is None:
        operands = f"{type_name(left)} and {type_name(right)}"
        raise fail("IRL227", where.source, where.span, op=op, operands=operands)
    return finite(result, where)


def _compare_or_compute(op: str, left: Number, right: Number, where: Where) -> Value | None:
    if op in _COMPARISONS:
        return _COMPARISONS[op](left, right)
    if op in ("/", "DIV", "MOD") and right == 0:
        raise fail("IRL502", where.source, where.span)
    if op == "/":
        return left / right
    if op in ("DIV", "MOD"):
        if not isinstance(left, int) or not isinstance(right, int):
            return None
        # Towards zero, as in the Pascal family; Python's own // rounds down.
        quotient = abs(left) // abs(right) * (1 if (left < 0) == (right < 0) else -1)
        return whole_number(quotient if op == "DIV" else left - right * quotient, "the result", where)
    computed: dict[str, Callable[[], Number]] = {
        "+": lambda: left + right,
        "-": lambda: left - right,
        "*": lambda: left * right,
    }
    if op not in computed:
        return None
    number = computed[op]()
    return whole_number(number, "the result", where) if isinstance(number, int) else number


def _geometric(op: str, left: RecordValue, right: Value, where: Where) -> Value | None:
    if isinstance(right, RecordValue):
        return _of_two_records(op, left, right)
    if left.type == POSITION and isinstance(right, int | float) and is_number(right) and op in ("*", "/"):
        if op == "/" and right == 0:
            raise fail("IRL502", where.source, where.span)
        return _scaled(left, float(right)) if op == "*" else _divided(left, float(right))
    return None


def _of_two_records(op: str, left: RecordValue, right: RecordValue) -> Value | None:
    kinds = (left.type.name, right.type.name)
    if op in ("+", "-") and kinds == (POSITION.name, POSITION.name):
        return _shifted(vector_of(left), vector_of(right), op)
    if op in ("+", "-") and kinds == (POSE.name, POSITION.name):
        at, turned = parts_of(left)
        return pose(vector_of(_shifted(at, vector_of(right), op)), turned)
    if op == "@" and kinds == (POSE.name, POSE.name):
        return compose(left, right)
    if op == "@" and kinds == (POSE.name, POSITION.name):
        at, turned = parts_of(left)
        return _shifted(at, rotate(turned, vector_of(right)), "+")
    if op == "@" and kinds == (ORIENTATION.name, ORIENTATION.name):
        return orientation(multiply(quaternion_of(left), quaternion_of(right)))
    if op == "*" and kinds == (ORIENTATION.name, POSITION.name):
        return position(rotate(quaternion_of(left), vector_of(right)))
    return None


def _shifted(at: Vector, by: Vector, op: str) -> RecordValue:
    sign = 1.0 if op == "+" else -1.0
    return position((at[0] + sign * by[0], at[1] + sign * by[1], at[2] + sign * by[2]))


def _scaled(value: RecordValue, factor: float) -> RecordValue:
    x, y, z = vector_of(value)
    return position((x * factor, y * factor, z * factor))


def _divided(value: RecordValue, divisor: float) -> RecordValue:
    # Not times 1 / divisor, which is infinite for the smallest divisors even where the quotients are not.
    x, y, z = vector_of(value)
    return position((x / divisor, y / divisor, z / divisor))
