"""Expressions of BOOLs that Pascal would read differently, because there AND and OR bind like `*` and `+`."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from irlx.language import tree
from irlx.language.checking.operators import COMPARISONS, LOGIC, binary_type
from irlx.language.types import UNKNOWN, Type

Reading: TypeAlias = "tree.Expression | tuple[str, Reading, Reading]"
"""An operand, or an operator with the readings of its two sides."""

_STRENGTH = {"AND": 3, "OR": 2, "EXOR": 2} | dict.fromkeys(COMPARISONS, 1)


def both_readings(
    node: tree.Expression, type_of: Callable[[tree.Expression], Type], text_of: Callable[[tree.Node], str]
) -> tuple[str, str] | None:
    """An expression as irlx reads it and as Pascal would, with parentheses; None where they are one or Pascal
    would refuse it."""
    ours = _as_written(node)
    operands: list[tree.Expression] = []
    operators: list[str] = []
    _flatten(ours, operands, operators)
    pascals = _climb(operands, operators)
    if pascals == ours or _type(pascals, type_of) is None:
        return None
    return _shown(ours, text_of), _shown(pascals, text_of)


def _as_written(node: tree.Expression) -> Reading:
    if isinstance(node, tree.Binary) and (node.op in LOGIC or node.op in COMPARISONS):
        return node.op, _as_written(node.left), _as_written(node.right)
    return node


def _flatten(reading: Reading, operands: list[tree.Expression], operators: list[str]) -> None:
    if not isinstance(reading, tuple):
        operands.append(reading)
        return
    op, left, right = reading
    _flatten(left, operands, operators)
    operators.append(op)
    _flatten(right, operands, operators)


def _climb(operands: list[tree.Expression], operators: list[str]) -> Reading:
    """The reading of operands and the operators between them by the strengths of Pascal."""
    done: list[Reading] = [operands[0]]
    open_operators: list[str] = []

    def reduce() -> None:
        right, left = done.pop(), done.pop()
        done.append((open_operators.pop(), left, right))

    for op, operand in zip(operators, operands[1:], strict=True):
        while open_operators and _STRENGTH[open_operators[-1]] >= _STRENGTH[op]:
            reduce()
        open_operators.append(op)
        done.append(operand)
    while open_operators:
        reduce()
    return done[0]


def _type(reading: Reading, type_of: Callable[[tree.Expression], Type]) -> Type | None:
    if not isinstance(reading, tuple):
        type = type_of(reading)
        return None if type is UNKNOWN else type
    op, first, second = reading
    left, right = _type(first, type_of), _type(second, type_of)
    return None if left is None or right is None else binary_type(op, left, right)


def _shown(reading: Reading, text_of: Callable[[tree.Node], str]) -> str:
    shown = _in_parentheses(reading, text_of)
    return shown[1:-1] if isinstance(reading, tuple) else shown


def _in_parentheses(reading: Reading, text_of: Callable[[tree.Node], str]) -> str:
    if not isinstance(reading, tuple):
        return " ".join(text_of(reading).split())
    op, left, right = reading
    return f"({_in_parentheses(left, text_of)} {op} {_in_parentheses(right, text_of)})"
