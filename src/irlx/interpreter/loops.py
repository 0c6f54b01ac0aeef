"""FOR: a loop whose number of rounds is known when it begins."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from math import isfinite
from typing import TYPE_CHECKING, Any

from irlx.interpreter.code import Frame, Label, Step
from irlx.interpreter.compiled import Compiled, constant, first_failing
from irlx.interpreter.errors import fail
from irlx.interpreter.types import INT, REAL
from irlx.language import tree
from irlx.language.ranges import REAL_RANGE

if TYPE_CHECKING:
    from irlx.interpreter.statements import Statements

_NEARLY = 1e-9
"""Part of a step that a loop over REAL may miss its end by: 0.1 three times is not 0.3 exactly."""


def add_for(statements: Statements, node: tree.For) -> None:
    """Add the steps of a FOR. Raises InterpreterError: IRL222 for a variable that is no number, IRL211."""
    assembler, expressions = statements.assembler, statements.expressions
    type, set_, _ = expressions.designators.setter(node.variable, keep=True)
    if type not in (INT, REAL):
        data = {"expected": "a variable of type INT or REAL", "found": type.name}
        raise fail("IRL222", statements.context.source, node.variable.span, **data)
    given = [node.start, node.stop, *([node.step] if node.step is not None else [])]
    parts = expressions.operands([(part, partial(expressions.value, part, type)) for part in given])
    wrong = first_failing(parts)
    if wrong is not None:
        statements.run(node, wrong.run)
        return
    step_size = parts[2] if node.step is not None else constant(type, 1 if type == INT else 1.0)
    slot, again, end = assembler.slot(), Label(), Label()
    statements.run(node.variable, _begin(statements, node, slot, parts[0], parts[1], step_size))
    assembler.place(again)

    def make(following: int, end: int) -> Step:
        def step(frame: Frame) -> int:
            for value in frame[slot]:
                set_(frame, value)
                return following
            return end

        return step

    assembler.add(node.variable, make, end)
    statements.loop(node.body, end)
    assembler.jump(node, again)
    assembler.place(end)


def _begin(
    statements: Statements, node: tree.For, slot: int, start: Compiled, stop: Compiled, size: Compiled
) -> Any:
    """What puts the values of the variable into a slot, as an iterator."""
    source, sign = statements.context.source, -1 if node.down else 1
    first, last, by = start.run, stop.run, size.run
    whole = start.type == INT

    def begin(frame: Frame) -> None:
        low, high, step = first(frame), last(frame), by(frame)
        if not step > 0:
            place = node.step or node
            data = {
                "param": "STEP",
                "expected": "greater than 0",
                "value": str(step) if whole else f"{step:g}",
            }
            raise fail("IRL505", source, place.span, **data)
        if whole:
            frame[slot] = iter(range(low, high + sign, sign * step))
        elif not isfinite(high - low):
            what = "the way from the first value of FOR to the last"
            raise fail("IRL503", source, node.stop.span, what=what, type="REAL", range=REAL_RANGE)
        else:
            frame[slot] = _reals(low, sign * step, sign * (high - low) / step)

    return begin


def _reals(start: float, step: float, rounds: float) -> Iterator[float]:
    """Values from `start` on, each by its number: adding up would add up rounding, too."""
    number = 0
    while number <= rounds + _NEARLY:
        yield start + number * step
        number += 1
