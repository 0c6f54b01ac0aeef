"""Motion statements and switches: program tree -> steps that yield blocks."""

from __future__ import annotations

from functools import partial
from typing import Any

from irlx.blocks import (
    Block,
    CriterionBlock,
    CyclicBlock,
    FreezeBlock,
    LimitKind,
    LimitSwitchBlock,
    ObstacleBlock,
    ReconfigureBlock,
)
from irlx.interpreter.code import Assembler
from irlx.interpreter.expressions import Expressions
from irlx.interpreter.frames import base_of, link_frame_of
from irlx.interpreter.law import Law
from irlx.interpreter.motion_parts import Make, MotionParts, NextId
from irlx.interpreter.moves import Moves
from irlx.interpreter.obstacles import obstacle_of_cell
from irlx.interpreter.parameters import choice_of, criterion_name, criterion_params
from irlx.interpreter.types import INT
from irlx.language import tree


class Motion(MotionParts):
    """Compiles motion statements and switches of one body."""

    def __init__(self, expressions: Expressions, assembler: Assembler) -> None:
        super().__init__(expressions, assembler)
        self._moves = Moves(expressions, assembler)

    def add(self, statement: tree.Statement) -> bool:
        """Add the steps of a statement; False where it is of another kind. Raises InterpreterError."""
        match statement:
            case tree.Move():
                self._moves.add(statement)
            case tree.Reconfiguration():
                self._reconfigure(statement)
            case tree.LimitSwitch() | tree.FreezeStart() | tree.CriterionStart():
                self._switch_on(statement)
            case tree.LimitSwitchEnd() | tree.FreezeEnd() | tree.CyclicStart() | tree.CyclicEnd():
                self._switch(statement)
            case tree.CriterionEnd():
                self._switch(statement)
            case tree.ObstacleStart() | tree.ObstacleEnd():
                self._obstacle(statement)
            case _:
                return False
        return True

    # ---- switches

    def _switch(self, node: tree.Statement) -> None:
        origin = self._origin(node)

        def make(_: list[Any], next_id: NextId) -> tuple[Block]:
            id = next_id()
            match node:
                case tree.LimitSwitchEnd():
                    return (LimitSwitchBlock(id=id, origin=origin, kind=LimitKind(node.kind), range=None),)
                case tree.FreezeEnd():
                    return (FreezeBlock(id=id, origin=origin, joints=()),)
                case tree.CriterionEnd(name=name):
                    return (CriterionBlock(id=id, origin=origin, name=criterion_name(name), choice=None),)
            return (CyclicBlock(id=id, origin=origin, active=isinstance(node, tree.CyclicStart)),)

        self._emit(node, (), make)

    def _obstacle(self, node: tree.ObstacleStart | tree.ObstacleEnd) -> None:
        """Raises InterpreterError, IRL573."""
        origin, active = self._origin(node), isinstance(node, tree.ObstacleStart)
        name = obstacle_of_cell(node.name, self._context)

        def make(_: list[Any], next_id: NextId) -> tuple[Block]:
            return (ObstacleBlock(id=next_id(), origin=origin, name=name, active=active),)

        self._emit(node, (), make)

    def _switch_on(self, node: tree.LimitSwitch | tree.FreezeStart | tree.CriterionStart) -> None:
        origin, value = self._origin(node), self._expressions.value
        make: Make
        if isinstance(node, tree.LimitSwitch):
            kind = LimitKind(node.kind)
            parts = self._expressions.operands(self._range(node))

            def make(values: list[Any], next_id: NextId) -> tuple[Block]:
                range = self._joint_range(values)
                return (LimitSwitchBlock(id=next_id(), origin=origin, kind=kind, range=range),)

        elif isinstance(node, tree.FreezeStart):
            parts = self._expressions.operands([(joint, partial(value, joint, INT)) for joint in node.joints])

            def make(values: list[Any], next_id: NextId) -> tuple[Block]:
                return (FreezeBlock(id=next_id(), origin=origin, joints=tuple(values)),)

        else:
            parts = self._expressions.operands(criterion_params(node, self._expressions))

            def make(values: list[Any], next_id: NextId) -> tuple[Block]:
                choice = choice_of(node, values, self._context.source)
                return (CriterionBlock(id=next_id(), origin=origin, name=choice.name, choice=choice),)

        self._emit(node, parts, make)

    # ---- RECONFIGURATION

    def _reconfigure(self, node: tree.Reconfiguration) -> None:
        origin, law = self._origin(node), Law(node, self._expressions)
        posture = self._expressions.one_of(node.target, self._postures())
        name = None if node.frame is None else node.frame.name
        frame = link_frame_of(base_of(name, self._context, node))

        def make(values: list[Any], next_id: NextId) -> tuple[Block]:
            target, bounds = self._posture(values[0]), law.latched(())
            block = ReconfigureBlock(id=next_id(), origin=origin, target=target, law=bounds, frame=frame)
            return (block,)

        self._emit(node, (posture,), make)
