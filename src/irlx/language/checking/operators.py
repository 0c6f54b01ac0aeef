"""Operators: which types they take, which they give, and the values of numbers that the text tells."""

from __future__ import annotations

from irlx.language import tree
from irlx.language.checking.names import Constant
from irlx.language.types import (
    BOOL,
    CHAR,
    INT,
    ORIENTATION,
    POSE,
    POSITION,
    REAL,
    STRING,
    UNKNOWN,
    Type,
)

COMPARISONS = frozenset({"=", "<>", "<", ">", "<=", ">="})
LOGIC = frozenset({"AND", "OR", "EXOR"})
DIVISIONS = frozenset({"/", "DIV", "MOD"})


def _table() -> dict[tuple[str, str, str], Type]:
    table: dict[tuple[str, str, str], Type] = {}

    def add(ops: str, left: Type, right: Type, result: Type) -> None:
        for op in ops.split():
            table[op, left.name, right.name] = result

    for left in (INT, REAL):
        for right in (INT, REAL):
            add("+ - *", left, right, INT if left is right is INT else REAL)
            add("/", left, right, REAL)
            add("= <> < > <= >=", left, right, BOOL)
        add("* /", POSITION, left, POSITION)
        add("*", left, POSITION, POSITION)
    add("DIV MOD", INT, INT, INT)
    add("AND OR EXOR = <>", BOOL, BOOL, BOOL)
    for left in (CHAR, STRING):
        for right in (CHAR, STRING):
            add("= <>", left, right, BOOL)
            add("+", left, right, STRING)
    add("< > <= >=", CHAR, CHAR, BOOL)
    add("+ -", POSITION, POSITION, POSITION)
    add("+ -", POSE, POSITION, POSE)
    add("@", POSE, POSE, POSE)
    add("@", POSE, POSITION, POSITION)
    add("@", ORIENTATION, ORIENTATION, ORIENTATION)
    add("*", ORIENTATION, POSITION, POSITION)
    return table


_RESULTS = _table()
_UNARY = {
    ("NOT", "BOOL"): BOOL,
    ("+", "INT"): INT,
    ("-", "INT"): INT,
    ("+", "REAL"): REAL,
    ("-", "REAL"): REAL,
}


def binary_type(op: str, left: Type, right: Type) -> Type | None:
    """Type of the result, or None where the operator is not defined for these types."""
    if left is UNKNOWN or right is UNKNOWN:
        return BOOL if op in COMPARISONS or op in LOGIC else UNKNOWN
    return _RESULTS.get((op, left.name, right.name))


def aggregate_type(op: str, other: Type, values: int, *, on_left: bool) -> Type | None:
    """Type of several values in parentheses beside an operand of a type, None where none or several would do.

    `values` is how many there are; `on_left` says on which side of the operator they stand.
    """
    if other is UNKNOWN:
        return UNKNOWN
    found = [
        type
        for type in (POSITION, ORIENTATION, POSE)
        if ((op, type.name, other.name) if on_left else (op, other.name, type.name)) in _RESULTS
    ]
    fitting = [type for type in found if len(type.fields) == values] or found
    return fitting[0] if len(fitting) == 1 else None


def values_in_parentheses(node: tree.Expression) -> int:
    """How many values stand in parentheses where there are several, else 0."""
    while isinstance(node, tree.Paren):
        node = node.value
    return len(node.items) if isinstance(node, tree.Aggregate) else 0


def unary_type(op: str, operand: Type) -> Type | None:
    """Type of the result, or None where the operator is not defined for that type."""
    if operand is UNKNOWN:
        return BOOL if op == "NOT" else UNKNOWN
    return _UNARY.get((op, operand.name))


def unary_value(op: str, value: Constant | None) -> Constant | None:
    """Value of a sign or negation where the operand's is known."""
    if isinstance(value, bool):
        return not value if op == "NOT" else None
    if isinstance(value, int | float):
        return -value if op == "-" else value
    return None


def binary_value(op: str, left: Constant | None, right: Constant | None, result: Type) -> Constant | None:
    """Value of arithmetic or a comparison of numbers that are known; the divisor is not 0.

    A value beyond the range of its type is given as it is.
    """
    if not isinstance(left, int | float) or not isinstance(right, int | float):
        return None
    if isinstance(left, bool) or isinstance(right, bool):
        return None
    if result is INT:
        return _whole(op, int(left), int(right))
    if result is REAL:
        try:
            return _real(op, float(left), float(right))
        except OverflowError:
            return None
    return None


def _whole(op: str, left: int, right: int) -> int | None:
    match op:
        case "+":
            return left + right
        case "-":
            return left - right
        case "*":
            return left * right
        case "DIV" | "MOD":
            # Towards zero, as in the Pascal family; Python's own // rounds down.
            quotient = abs(left) // abs(right) * (1 if (left < 0) == (right < 0) else -1)
            return quotient if op == "DIV" else left - right * quotient
    return None


def _real(op: str, left: float, right: float) -> float | None:
    match op:
        case "+":
            return left + right
        case "-":
            return left - right
        case "*":
            return left * right
        case "/":
            return left / right
    return None
