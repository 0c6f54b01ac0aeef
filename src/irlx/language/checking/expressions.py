"""Types of expressions."""

from __future__ import annotations

from collections.abc import Callable
from math import isinf
from typing import Any

from irlx.language import tree
from irlx.language.checking.calls import Calls
from irlx.language.checking.context import NOTHING, Typed
from irlx.language.checking.designators import Designators
from irlx.language.checking.operators import (
    COMPARISONS,
    DIVISIONS,
    LOGIC,
    aggregate_type,
    binary_type,
    binary_value,
    unary_type,
    unary_value,
    values_in_parentheses,
)
from irlx.language.checking.parentheses import Parentheses
from irlx.language.checking.pascal import both_readings
from irlx.language.ranges import INT_LIMIT, INT_RANGE, REAL_RANGE
from irlx.language.types import BOOL, CHAR, INT, REAL, SEMAPHORE, STRING, UNKNOWN, Type, fits, is_number

_SHORT = frozenset({"AND", "OR"})
_OF_VALUES = frozenset({"IRL502", "IRL503", "IRL504"})


class Expressions(Designators, Parentheses, Calls):
    """Types of expressions of all kinds."""

    _unlike_pascal = False

    def typed(self, node: tree.Argument) -> Typed:
        """Type of an expression of which no type is expected."""
        return _TYPED[type(node)](self, node)

    def fitted(self, node: tree.Argument, expected: Type) -> Typed:
        """Type of an expression where one is expected; another one is a finding, IRL222."""
        kind = type(node)
        if kind is tree.Aggregate or kind is tree.Paren:
            return self.in_parentheses(node, expected)  # type: ignore[arg-type]
        found = _TYPED[kind](self, node)
        if found.type is expected or fits(found.type, expected) or _becomes(node, found.type, expected):
            return found
        self.mismatch(node, expected.name, found.type.name)
        return Typed(expected)

    def whole(self, node: tree.Expression) -> Typed:
        """An expression that must be an INT."""
        return self.fitted(node, INT)

    # ---- literals

    def _int_literal(self, node: tree.IntLiteral) -> Typed:
        if node.value >= INT_LIMIT:
            # Longer ones are told where the text is split into words.
            if node.value == INT_LIMIT:
                self._out_of_range(node, f"the number {node.value}", INT)
            return Typed(INT)
        return Typed(INT, node.value)

    def _real_literal(self, node: tree.RealLiteral) -> Typed:
        return Typed(REAL, node.value)

    def _string_literal(self, node: tree.StringLiteral) -> Typed:
        return Typed(STRING, node.value)

    def _bool_literal(self, node: tree.BoolLiteral) -> Typed:
        return Typed(BOOL, node.value)

    def _parenthesised(self, node: tree.Aggregate | tree.Paren) -> Typed:
        return self.in_parentheses(node, None)

    # ---- operators

    def _unary(self, node: tree.Unary) -> Typed:
        if node.op == "-" and isinstance(node.operand, tree.IntLiteral) and node.operand.value == INT_LIMIT:
            return Typed(INT, -INT_LIMIT)
        operand = self.typed(node.operand)
        result = unary_type(node.op, operand.type)
        if result is None:
            self.add("IRL227", node, op=node.op, operands=operand.type.name)
            return NOTHING
        return self._in_range(node, Typed(result, unary_value(node.op, operand.value)))

    def _binary(self, node: tree.Binary, *, inside: bool = False) -> Typed:
        """A chain of operators along its left sides; `inside` a larger one it is judged with that."""
        outer, self._unlike_pascal = self._unlike_pascal, inside and self._unlike_pascal
        chain = [node]
        left = node.left
        while isinstance(left, tree.Binary):
            chain.append(left)
            left = left.left
        found, right = self._leftmost(left, chain[-1])
        for binary in reversed(chain):
            found = self._applied(binary, found, right)
            right = None
        if inside:
            return found
        if self._unlike_pascal and node.op in LOGIC:
            self._warn_of_pascal(node)
        self._unlike_pascal = outer
        return found

    def _applied(self, node: tree.Binary, left: Typed, right: Typed | None) -> Typed:
        """The result of an operator; `right` is the operand on that side where it has been looked at."""
        op = node.op
        if op in _SHORT:
            return self._short_circuit(node, left)
        right = right or self._right(node, left.type)
        result = binary_type(op, left.type, right.type)
        if result is None and op in COMPARISONS and CHAR in (left.type, right.type):
            # A literal of one sign is ordered where it stands beside a CHAR.
            first, second = (
                CHAR if _is_sign(side) else found.type
                for side, found in ((node.left, left), (node.right, right))
            )
            result = binary_type(op, first, second)
        if result is None:
            self.add("IRL227", node, op=op, operands=f"{left.type.name} and {right.type.name}")
            return NOTHING
        if op in COMPARISONS:
            self._compared(node, left.type, right.type)
            return Typed(result)
        if op == "EXOR":
            self._unlike_pascal = True
        if op in DIVISIONS and right.value == 0 and is_number(right.type):
            self.add("IRL502", node)
            return Typed(result)
        if left.value is None or right.value is None:
            return Typed(result)
        return self._in_range(node, Typed(result, binary_value(op, left.value, right.value, result)))

    def _leftmost(self, left: tree.Expression, node: tree.Binary) -> tuple[Typed, Typed | None]:
        """The first operand of a chain; with it the second one where that tells what the first is."""
        if node.op in _SHORT and isinstance(left, tree.Aggregate | tree.Paren):
            return self.fitted(left, BOOL), None
        values = values_in_parentheses(left)
        if not values or node.op in _SHORT or values_in_parentheses(node.right):
            return self.typed(left), None
        right = self._right(node, UNKNOWN)
        type = aggregate_type(node.op, right.type, values, on_left=True)
        return (self.typed(left) if type is None else self.fitted(left, type)), right

    def _right(self, node: tree.Binary, left: Type) -> Typed:
        right = node.right
        if node.op in _SHORT and isinstance(right, tree.Aggregate | tree.Paren):
            return self.fitted(right, BOOL)
        values = values_in_parentheses(right)
        type = aggregate_type(node.op, left, values, on_left=False) if values else None
        if type is not None:
            return self.fitted(right, type)
        return self._binary(right, inside=True) if isinstance(right, tree.Binary) else self.typed(right)

    def _compared(self, node: tree.Binary, left: Type, right: Type) -> None:
        if left is BOOL or right is BOOL:
            self._unlike_pascal = True
        elif node.op in ("=", "<>") and is_number(left) and is_number(right) and not left is right is INT:
            self.lint("IRL286", node, op=node.op)

    def _short_circuit(self, node: tree.Binary, left: Typed) -> Typed:
        self._operand(node.left, left)
        if left.value is (node.op == "OR"):
            # The right side has no value to go wrong.
            trial = self.trial(lambda: self._right(node, BOOL))
            findings = [finding for finding in trial.findings if finding.code not in _OF_VALUES]
            right = self.keep(trial._replace(findings=findings))
        else:
            right = self._right(node, BOOL)
        self._operand(node.right, right)
        return Typed(BOOL)

    def _operand(self, node: tree.Expression, found: Typed) -> None:
        if found.type is not BOOL and found.type is not UNKNOWN:
            self.mismatch(node, "BOOL", found.type.name)

    def _warn_of_pascal(self, node: tree.Binary) -> None:
        def type_of(part: tree.Expression) -> Type:
            return self.trial(lambda: self.typed(part)).typed.type

        readings = both_readings(node, type_of, self.text)
        if readings is not None:
            self.add("IRL280", node, ours=readings[0], pascals=readings[1])

    # ---- ranges

    def _in_range(self, node: tree.Node, found: Typed) -> Typed:
        value = found.value
        if isinstance(value, bool) or not isinstance(value, int | float):
            return found
        if found.type is INT and not -INT_LIMIT <= value < INT_LIMIT:
            return self._out_of_range(node, "the result", INT)
        if found.type is REAL and isinf(value):
            return self._out_of_range(node, "the result", REAL)
        return found

    def _out_of_range(self, node: tree.Node, what: str, type: Type) -> Typed:
        range = INT_RANGE if type is INT else REAL_RANGE
        self.add("IRL503", node, what=what, type=type.name, range=range)
        return Typed(type)


def _becomes(node: tree.Argument, found: Type, expected: Type) -> bool:
    """Whether a value becomes one of another type: a literal of one sign a CHAR, a count a SEMAPHORE."""
    if expected is CHAR:
        return _is_sign(node)
    return expected is SEMAPHORE and found is INT


def _is_sign(node: tree.Argument) -> bool:
    """Whether an expression is a literal text of one sign, in parentheses or not."""
    while isinstance(node, tree.Paren):
        node = node.value
    return isinstance(node, tree.StringLiteral) and len(node.value) == 1


_TYPED: dict[type[tree.Node], Callable[[Expressions, Any], Typed]] = {
    tree.IntLiteral: Expressions._int_literal,
    tree.RealLiteral: Expressions._real_literal,
    tree.StringLiteral: Expressions._string_literal,
    tree.BoolLiteral: Expressions._bool_literal,
    tree.Designator: Expressions.designated,
    tree.FunctionCall: Expressions.function_call,
    tree.Aggregate: Expressions._parenthesised,
    tree.Paren: Expressions._parenthesised,
    tree.Unary: Expressions._unary,
    tree.Binary: Expressions._binary,
    tree.FormattedValue: Expressions.formatted,
}
