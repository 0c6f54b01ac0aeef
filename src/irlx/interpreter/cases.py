"""CASE: a step that finds the branch of a value."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from irlx.interpreter.code import Frame, Label, Step
from irlx.interpreter.compiled import Compiled, Run, failing
from irlx.interpreter.errors import fail
from irlx.interpreter.types import BOOL, CHAR, INT, STRING, Type
from irlx.language import tree

if TYPE_CHECKING:
    from irlx.interpreter.statements import Statements

_ORDERED = (INT, CHAR)


def add_case(statements: Statements, node: tree.Case) -> None:
    """Add the steps of a CASE: the first label that holds the value counts, without one DEFAULT.

    Raises InterpreterError: IRL222 for a selector or labels of a type that CASE does not take.
    """
    assembler, source = statements.assembler, statements.context.source
    selector = statements.expressions.value(node.selector)
    if selector.type is not None and selector.type not in (*_ORDERED, BOOL, STRING):
        data = {"expected": "INT, CHAR, STRING or BOOL", "found": selector.type.name}
        raise fail("IRL222", source, node.selector.span, **data)
    choice = _Choice(selector.run)
    bodies = [Label() for _ in node.branches]
    for number, branch in enumerate(node.branches):
        for label in branch.labels:
            choice.add(_bounds(statements, label, selector), number)
    otherwise, end = Label(), Label()

    def make(following: int, otherwise: int, *bodies: int) -> Step:
        return choice.step(otherwise, bodies)

    assembler.add(node.selector, make, otherwise, *bodies)
    for place, branch in zip(bodies, node.branches, strict=True):
        assembler.place(place)
        statements.body(branch.body)
        assembler.jump(node, end)
    assembler.place(otherwise)
    statements.body(node.default or ())
    assembler.place(end)


def _bounds(
    statements: Statements, label: tree.Expression | tree.Range, selector: Compiled
) -> tuple[Compiled, Compiled | None]:
    """A label's value, or its two bounds, as values of the selector's type."""
    type: Type | None = selector.type
    source = statements.context.source
    if not isinstance(label, tree.Range):
        return _label(statements, label, type), None
    if type not in (*_ORDERED, None):
        data = {"expected": "INT or CHAR before a CASE with ranges", "found": type.name if type else ""}
        return failing(fail("IRL222", source, label.span, **data)), None
    return _label(statements, label.lower, type), _label(statements, label.upper, type)


def _label(statements: Statements, node: tree.Expression, type: Type | None) -> Compiled:
    if statements.expressions.suspends(node):
        return failing(fail("IRL590", statements.context.source, node.span, what="a call in a label of CASE"))
    return statements.expressions.value(node, type)


class _Choice:
    """Finds the branch of a value: single constants in a table, all others in the order of the text."""

    def __init__(self, selector: Run) -> None:
        self._selector = selector
        self._table: dict[Any, int] = {}
        self._others: list[tuple[int, Run, Run | None]] = []

    def add(self, bounds: tuple[Compiled, Compiled | None], branch: int) -> None:
        low, high = bounds
        if high is None and low.constant and not self._others:
            self._table.setdefault(low.run([]), branch)
        else:
            self._others.append((branch, low.run, None if high is None else high.run))

    def step(self, otherwise: int, bodies: tuple[int, ...]) -> Step:
        selector, others = self._selector, self._others
        table = {value: bodies[branch] for value, branch in self._table.items()}

        def step(frame: Frame) -> int:
            value = selector(frame)
            found = table.get(value)
            if found is not None:
                return found
            for branch, low, high in others:
                least = low(frame)
                if value == least if high is None else least <= value <= high(frame):
                    return bodies[branch]
            return otherwise

        return step
