"""Calls in expressions and statements: built-ins at once, routines of the program as steps of the machine."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import inf
from typing import TYPE_CHECKING, Any

from irlx.interpreter.code import Frame, Label, Step
from irlx.interpreter.compiled import Compiled, Run, failing, first_failing
from irlx.interpreter.conversion import finite, whole_number
from irlx.interpreter.errors import InterpreterError, fail
from irlx.interpreter.functions import Function
from irlx.interpreter.rotations import CONVENTIONS
from irlx.interpreter.scope import Parameter, Routine
from irlx.interpreter.types import BOOL, INT, REAL, Type
from irlx.language import tree
from irlx.language.words import count

if TYPE_CHECKING:
    from irlx.interpreter.expressions import Expressions


class Calls:
    """Compiles calls for expressions."""

    def __init__(self, expressions: Expressions) -> None:
        self._expressions = expressions

    # ---- built-ins

    def built_in(self, function: Function, parts: Sequence[Compiled], result: Type, node: tree.Node) -> Run:
        """Applies a built-in to arguments that fit; when run, IRL506 where it has no value, and IRL503."""
        where = self._expressions.where(node)
        runs = tuple(part.run for part in parts)
        apply: Run = function.apply

        def run(frame: Frame) -> Any:
            values = [part(frame) for part in runs]
            try:
                found = apply(*values)
            except (ValueError, OverflowError, ZeroDivisionError, KeyError) as cause:
                if isinstance(cause, OverflowError) and result == REAL:
                    return finite(inf, where)
                data = {"function": function.name, "value": ", ".join(map(_shown, values, parts))}
                if isinstance(cause, KeyError):
                    data["help"] = f"modes are {', '.join(CONVENTIONS)}"
                raise fail("IRL506", where.source, where.span, **data) from None
            if result == INT:
                return whole_number(found, "the result", where)
            return finite(found, where)

        return run

    # ---- routines of the program

    def function(self, routine: Routine, given: Sequence[tree.Expression], node: tree.Node) -> Compiled:
        """Value of a call of a function. Raises InterpreterError: IRL222 for a procedure, IRL228, IRL590."""
        source = self._expressions.source
        if routine.result is None:
            data = {"expected": "a value", "found": f"the procedure {routine.name}"}
            raise fail("IRL222", source, node.span, **data)
        if self._expressions.context.assembler is None:
            raise fail("IRL590", source, node.span, what=f"the function {routine.name} in a constant")
        slot = self._expressions.context.assembler.slot()
        wrong = self.call(routine, given, node, slot)
        return wrong or Compiled(routine.result, lambda frame: frame[slot])

    def call(
        self, routine: Routine, given: Sequence[tree.Expression], node: tree.Node, slot: int = -1
    ) -> Compiled | None:
        """Add the steps of a call whose result goes to a slot; what fails for a wrong argument, or None.

        Raises InterpreterError, IRL228, for a wrong number of arguments.
        """
        context = self._expressions.context
        assembler, machine = context.assembler, context.machine
        if assembler is None:
            raise TypeError("constants do not call")
        if len(given) != len(routine.parameters):
            expected = count(len(routine.parameters), "value")
            data = {"function": routine.name, "expected": expected, "found": len(given)}
            raise fail("IRL228", context.source, node.span, **data)
        pairs = zip(given, routine.parameters, strict=True)
        name = routine.name
        parts = self._expressions.operands([(a, partial(self._argument, a, p, name)) for a, p in pairs])
        wrong = first_failing(parts)
        if wrong is not None:
            return wrong
        runs, code, own, span = tuple(part.run for part in parts), routine.code, assembler.code, node.span

        def make(following: int) -> Step:
            def step(frame: Frame) -> int:
                arguments = [run(frame) for run in runs]
                return machine.enter(code, arguments, (own, frame, following, slot, span))

            return step

        assembler.add(node, make)
        return None

    def _argument(self, node: tree.Expression, parameter: Parameter, routine: str) -> Compiled:
        if not parameter.by_reference:
            return self._expressions.value(node, parameter.type)
        try:
            where = f"the VAR parameter '{parameter.name}' of {routine}"
            found = self._expressions.designators.cell(node, where)
        except InterpreterError as error:
            return failing(error)
        if found.type == parameter.type:
            return found
        data = {"expected": parameter.type.name, "found": found.type.name if found.type else ""}
        return failing(fail("IRL222", self._expressions.source, node.span, **data))

    # ---- AND, OR

    def in_need(
        self, node: tree.Binary, left: Compiled, decided: bool, right: Callable[[], Compiled]
    ) -> Compiled:
        """AND or OR whose right side calls or asks: only where the left side is not `decided`."""
        assembler = self._expressions.context.assembler
        if assembler is None:
            found = right()
            return found if found.type is None else Compiled(BOOL, found.run)
        slot, end, first = assembler.slot(), Label(), left.run

        def make_left(following: int, end: int) -> Step:
            def step(frame: Frame) -> int:
                frame[slot] = value = first(frame)
                return end if value is decided else following

            return step

        assembler.add(node.left, make_left, end)
        second = right().run

        def make_right(following: int) -> Step:
            def step(frame: Frame) -> int:
                frame[slot] = second(frame)
                return following

            return step

        assembler.add(node.right, make_right)
        assembler.place(end)
        return Compiled(BOOL, lambda frame: frame[slot])


def _shown(value: Any, part: Compiled) -> str:
    """A value as messages give it."""
    if isinstance(value, float):
        return f"{value:g}"
    if isinstance(value, str):
        return f"'{value}'"
    return str(value) if part.type == INT or part.type is None else part.type.name
