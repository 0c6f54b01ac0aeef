"""What all motion statements are made of: steps that yield blocks, postures, and limits of joints."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, TypeAlias

from irlx.blocks import Block, JointRange, JointTarget, Origin
from irlx.interpreter.code import Assembler, Frame, Step
from irlx.interpreter.compiled import Compiled, first_failing
from irlx.interpreter.expressions import Expressions
from irlx.interpreter.joints import si_values
from irlx.interpreter.targets import origin_of
from irlx.interpreter.types import Type
from irlx.interpreter.values import RecordValue
from irlx.language import tree
from irlx.language.builtins import LIMIT_TYPES

Wanted: TypeAlias = "list[tuple[tree.Node, Callable[[], Compiled]]]"
"""Expressions of a statement, each with what compiles it."""

NextId: TypeAlias = "Callable[[], int]"
"""Gives the number of the next block."""

Make: TypeAlias = "Callable[[list[Any], NextId], Sequence[Block]]"
"""The blocks of the values of a statement's expressions."""


class MotionParts:
    """Base of what compiles motion statements of one body."""

    def __init__(self, expressions: Expressions, assembler: Assembler) -> None:
        self._expressions = expressions
        self._assembler = assembler
        self._context = expressions.context

    def _emit(self, node: tree.Node, parts: Sequence[Compiled], make_blocks: Make) -> None:
        """Add a step that yields blocks made of the values of expressions."""
        machine = self._context.machine
        wrong = first_failing(parts)
        runs = [wrong.run] if wrong is not None else [part.run for part in parts]

        def make(following: int) -> Step:
            def step(frame: Frame) -> int:
                values = [run(frame) for run in runs]
                return machine.emit(make_blocks(values, machine.next_id), following)

            return step

        self._assembler.add(node, make)

    def _origin(self, node: tree.Node, last: tree.Node | None = None) -> Origin:
        return origin_of(self._context.source, node, last)

    def _type(self, key: str) -> Type:
        found = self._expressions.scope.type(key)
        if found is None:
            raise TypeError("joint types are predefined")
        return found

    def _postures(self) -> tuple[Type, Type]:
        """Types of what gives a posture."""
        return self._type("main_joint"), self._type("joint")

    def _posture(self, value: RecordValue) -> JointTarget:
        return JointTarget(si_values(value, self._context.setting))

    def _range(self, node: tree.LimitSwitch | tree.WithLimit) -> Wanted:
        types = (self._type(key) for key in LIMIT_TYPES[node.kind])
        pairs = zip((node.lower, node.upper), types, strict=True)
        return [(bound, partial(self._expressions.value, bound, type)) for bound, type in pairs]

    def _joint_range(self, values: Sequence[RecordValue]) -> JointRange:
        lower, upper = (si_values(value, self._context.setting) for value in values)
        return JointRange(lower, upper)
