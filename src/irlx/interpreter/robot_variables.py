"""System variables that the robot follows, R_TOOL and R_WEIGHTS: what changes them is a block."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from irlx.blocks import Block, ToolBlock, WeightsBlock
from irlx.interpreter.base import rotation_parts
from irlx.interpreter.code import Frame, Step
from irlx.interpreter.errors import fail
from irlx.interpreter.scope import Followed
from irlx.interpreter.targets import origin_of
from irlx.interpreter.values import ArrayValue, Value, share
from irlx.language import tree

if TYPE_CHECKING:
    from irlx.interpreter.context import Context
    from irlx.interpreter.statements import Statements


def add_change(statements: Statements, node: tree.Assignment, variable: Followed) -> None:
    """Add the steps of an assignment to such a variable or a part of it.

    A value that it has already is no change and gives no block. Raises InterpreterError as an assignment
    does; when run IRL570 for a frame without an orientation, IRL505 for a weight that is not above 0.
    """
    context, machine = statements.context, statements.context.machine
    keep = statements.expressions.suspends(node.value)
    designators = statements.expressions.designators
    type, set_, _ = designators.setter(node.target, keep=keep, followed=True)
    run = statements.expressions.value(node.value, type).run

    def make(following: int) -> Step:
        def step(frame: Frame) -> int:
            before = variable.value
            # Arrays change in place unless somebody relies on them.
            share(before)
            set_(frame, run(frame))
            block = _block(variable.name, variable.value, context, node)
            if variable.value == before:
                return following
            return machine.emit((block(machine.next_id()),), following)

        return step

    statements.assembler.add(node, make)


def _block(name: str, value: Value, context: Context, node: tree.Assignment) -> Callable[[int], Block]:
    """What makes the block of a value once it has a number."""
    origin = origin_of(context.source, node)
    if isinstance(value, ArrayValue):
        weights = tuple(float(weight) for weight in value.values if isinstance(weight, int | float))
        for number, weight in enumerate(weights, 1):
            if not weight > 0.0:
                data = {"param": f"R_WEIGHTS[{number}]", "expected": "greater than 0", "value": f"{weight:g}"}
                raise fail("IRL505", context.source, node.value.span, **data)
        return lambda id: WeightsBlock(id=id, origin=origin, weights=weights)
    (px, py, pz), (w, x, y, z) = rotation_parts(value, name, context, node)
    at = (px * 1e-3, py * 1e-3, pz * 1e-3)
    return lambda id: ToolBlock(id=id, origin=origin, position=at, orientation=(x, y, z, w))
