"""Motion statements and switches: program tree -> steps that yield blocks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import radians
from typing import Any, TypeAlias

from irlx.blocks import (
    ArcCourse,
    Block,
    CriterionBlock,
    CriterionClause,
    CyclicBlock,
    FreezeBlock,
    JointRange,
    JointTarget,
    LimitClause,
    LimitKind,
    LimitSwitchBlock,
    MoveBlock,
    MoveKind,
    Origin,
    PoseTarget,
    ReconfigureBlock,
)
from irlx.interpreter.code import Assembler, Frame, Step
from irlx.interpreter.compiled import Compiled, first_failing
from irlx.interpreter.errors import fail
from irlx.interpreter.expressions import Expressions
from irlx.interpreter.joints import si_values
from irlx.interpreter.law import law_of, law_parts
from irlx.interpreter.parameters import choice_of, criterion_name, criterion_params
from irlx.interpreter.support import missing_in_move
from irlx.interpreter.targets import origin_of, pose_target
from irlx.interpreter.types import INT, POSE, POSITION, REAL, STRING, Type
from irlx.interpreter.values import RecordValue
from irlx.language import tree

_LIMIT_TYPES = {
    "POSITION": ("main_joint_min", "main_joint_max"),
    "SPEED": ("main_joint_speed_min", "main_joint_speed_max"),
    "ACCELERATION": ("main_joint_accel_min", "main_joint_accel_max"),
}

Wanted: TypeAlias = "list[tuple[tree.Node, Callable[[], Compiled]]]"
"""Expressions of a statement, each with what compiles it."""

Make = Callable[[list[Any], int], Block]
"""A block of the values of a statement's expressions, with its number."""


class Motion:
    """Compiles motion statements and switches of one body."""

    def __init__(self, expressions: Expressions, assembler: Assembler) -> None:
        self._expressions = expressions
        self._assembler = assembler
        self._context = expressions.context

    def add(self, statement: tree.Statement) -> bool:
        """Add the steps of a statement; False where it is of another kind. Raises InterpreterError."""
        match statement:
            case tree.Move():
                self._move(statement)
            case tree.Reconfiguration():
                self._reconfigure(statement)
            case tree.LimitSwitch() | tree.FreezeStart() | tree.CriterionStart():
                self._switch_on(statement)
            case tree.LimitSwitchEnd() | tree.FreezeEnd() | tree.CyclicStart() | tree.CyclicEnd():
                self._switch(statement)
            case tree.CriterionEnd():
                self._switch(statement)
            case _:
                return False
        return True

    # ---- steps

    def _emit(self, node: tree.Node, parts: Sequence[Compiled], make_blocks: Sequence[Make]) -> None:
        """Add a step that yields blocks made of the values of expressions."""
        machine = self._context.machine
        wrong = first_failing(parts)
        runs = [wrong.run] if wrong is not None else [part.run for part in parts]

        def make(following: int) -> Step:
            def step(frame: Frame) -> int:
                values = [run(frame) for run in runs]
                return machine.emit([make(values, machine.next_id()) for make in make_blocks], following)

            return step

        self._assembler.add(node, make)

    def _origin(self, node: tree.Node, last: tree.Node | None = None) -> Origin:
        return origin_of(self._context.source, node, last)

    def _type(self, key: str) -> Type:
        found = self._expressions.scope.type(key)
        if found is None:
            raise TypeError("joint types are predefined")
        return found

    # ---- switches

    def _switch(self, node: tree.Statement) -> None:
        origin = self._origin(node)

        def make(_: list[Any], id: int) -> Block:
            match node:
                case tree.LimitSwitchEnd():
                    return LimitSwitchBlock(id=id, origin=origin, kind=LimitKind(node.kind), range=None)
                case tree.FreezeEnd():
                    return FreezeBlock(id=id, origin=origin, joints=())
                case tree.CriterionEnd(name=name):
                    return CriterionBlock(id=id, origin=origin, name=criterion_name(name), choice=None)
            return CyclicBlock(id=id, origin=origin, active=isinstance(node, tree.CyclicStart))

        self._emit(node, (), (make,))

    def _switch_on(self, node: tree.LimitSwitch | tree.FreezeStart | tree.CriterionStart) -> None:
        origin, value = self._origin(node), self._expressions.value
        make: Make
        if isinstance(node, tree.LimitSwitch):
            kind = LimitKind(node.kind)
            parts = self._expressions.operands(self._range(node))

            def make(values: list[Any], id: int) -> Block:
                return LimitSwitchBlock(id=id, origin=origin, kind=kind, range=self._joint_range(values))

        elif isinstance(node, tree.FreezeStart):
            parts = self._expressions.operands([(joint, partial(value, joint, INT)) for joint in node.joints])

            def make(values: list[Any], id: int) -> Block:
                return FreezeBlock(id=id, origin=origin, joints=tuple(values))

        else:
            parts = self._expressions.operands(criterion_params(node, self._expressions))

            def make(values: list[Any], id: int) -> Block:
                choice = choice_of(node, values, self._context.source)
                return CriterionBlock(id=id, origin=origin, name=choice.name, choice=choice)

        self._emit(node, parts, (make,))

    def _range(self, node: tree.LimitSwitch | tree.WithLimit) -> Wanted:
        types = (self._type(key) for key in _LIMIT_TYPES[node.kind])
        pairs = zip((node.lower, node.upper), types, strict=True)
        return [(bound, partial(self._expressions.value, bound, type)) for bound, type in pairs]

    def _joint_range(self, values: Sequence[RecordValue]) -> JointRange:
        lower, upper = (si_values(value, self._context.setting) for value in values)
        return JointRange(lower, upper)

    # ---- RECONFIGURATION

    def _reconfigure(self, node: tree.Reconfiguration) -> None:
        origin, law = self._origin(node), law_of(node, self._expressions)
        posture = self._expressions.one_of(node.target, self._postures())

        def make(values: list[Any], id: int) -> Block:
            target = JointTarget(si_values(values[0], self._context.setting))
            return ReconfigureBlock(id=id, origin=origin, target=target, law=law([]))

        self._emit(node, (posture,), (make,))

    def _postures(self) -> tuple[Type, Type]:
        return self._type("main_joint"), self._type("joint")

    # ---- MOVE

    def _move(self, node: tree.Move) -> None:
        missing = missing_in_move(node)
        if missing is not None:
            raise fail("IRL590", self._context.source, missing[0].span, what=missing[1])
        wanted, slices = self._move_parts(node)
        parts = self._expressions.operands(wanted)
        law, stops = law_of(node, self._expressions), _stops(node)

        def common(values: list[Any]) -> dict[str, Any]:
            """What all moves of the statement have, and the values of its targets and postures."""
            at = {name: values[part] for name, part in slices.items()}
            return {
                "law": law(at["law"]),
                "limits": tuple(self._limits(node, at["limits"])),
                "criteria": tuple(self._criteria(node, at["criteria"])),
            }

        def make_stop(number: int, values: list[Any], id: int) -> Block:
            via, end = stops[number]
            origin = self._origin(via or end, end) if len(stops) > 1 else self._origin(node)
            postures = self._posture_pairs(values[slices["postures"]], len(stops))[number]
            given = zip(node.targets, values[slices["targets"]], strict=True)
            targets = [self._target(target, value) for target, value in given]
            course = None
            if via is not None:
                travel = values[slices["course"]]
                course = self._course(node, targets[2 * number], travel, postures[0])
            return MoveBlock(
                id=id,
                origin=origin,
                kind=MoveKind(node.kind),
                target=targets[number if via is None else 2 * number + 1],
                course=course,
                reconfiguration=postures[1],
                **common(values),
            )

        self._emit(node, parts, [partial(make_stop, number) for number in range(len(stops))])

    def _move_parts(self, node: tree.Move) -> tuple[Wanted, dict[str, slice]]:
        """Expressions of a MOVE in the order of their evaluation, and where those of each kind are."""
        value, one_of = self._expressions.value, self._expressions.one_of
        given = {param.name.key: param.value for param in node.params}
        targets = (POSE, POSITION, *self._postures())
        groups: dict[str, Wanted] = {
            "law": law_parts(node, self._expressions),
            "limits": [p for c in node.clauses if isinstance(c, tree.WithLimit) for p in self._range(c)],
            "criteria": [
                part
                for clause in node.clauses
                if isinstance(clause, tree.WithCriterion)
                for part in criterion_params(clause, self._expressions)
            ],
            "postures": [
                (posture, partial(one_of, posture, self._postures()))
                for clause in node.clauses
                if isinstance(clause, tree.WithReconfiguration)
                for posture in clause.targets
            ],
            "targets": [(target, partial(self._of_target, target, targets)) for target in node.targets],
            "course": [
                (given[key], partial(value, given[key], REAL if key == "angle" else STRING))
                for key in ("angle", "circ_ori")
                if key in given
            ],
        }
        slices, start = {}, 0
        for name, group in groups.items():
            slices[name] = slice(start, start + len(group))
            start += len(group)
        return [part for group in groups.values() for part in group], slices

    def _of_target(self, node: tree.Expression, types: tuple[Type, ...]) -> Compiled:
        """A target; values in parentheses are never taken for a ROBTARGET."""
        if not isinstance(node, tree.Aggregate):
            mark = self._context.mark()
            found = self._expressions.value(node)
            if found.type == self._type("robtarget"):
                return found
            self._context.undo(mark)
        return self._expressions.one_of(node, types)

    def _limits(self, node: tree.Move, values: list[Any]) -> list[LimitClause]:
        clauses = [clause for clause in node.clauses if isinstance(clause, tree.WithLimit)]
        pairs = zip(clauses, values[::2], values[1::2], strict=True)
        return [
            LimitClause(LimitKind(clause.kind), self._joint_range(bounds), self._origin(clause))
            for clause, *bounds in pairs
        ]

    def _criteria(self, node: tree.Move, values: list[Any]) -> list[CriterionClause]:
        found, rest = [], list(values)
        for clause in node.clauses:
            if isinstance(clause, tree.WithCriterion):
                own, rest = rest[: len(clause.params)], rest[len(clause.params) :]
                choice = choice_of(clause, own, self._context.source)
                found.append(CriterionClause(choice, self._origin(clause)))
        return found

    def _posture_pairs(
        self, values: Sequence[RecordValue], moves: int
    ) -> list[tuple[JointTarget | None, JointTarget | None]]:
        """Postures of WITH RECONFIGURATION, at the via point and at the end of each move of a MOVE.

        A CIRCLE has one for each target, or one for each end point.
        """
        postures = [JointTarget(si_values(value, self._context.setting)) for value in values]
        if not postures:
            return [(None, None)] * moves
        if len(postures) == moves:
            return [(None, posture) for posture in postures]
        return list(zip(postures[::2], postures[1::2], strict=True))

    def _course(
        self, node: tree.Move, via: PoseTarget | JointTarget, travel: list[Any], posture: JointTarget | None
    ) -> ArcCourse:
        """Via point of a CIRCLE, its posture where it has one, with what ANGLE and CIRC_ORI say."""
        given = {param.name.key: param.value for param in node.params}
        values, source = iter(travel), self._context.source
        angle, turning = None, "END"
        if "angle" in given:
            angle = radians(next(values))
            if angle == 0.0:
                data = {"param": "ANGLE", "expected": "other than 0", "value": "0"}
                raise fail("IRL505", source, given["angle"].span, **data)
        if "circ_ori" in given:
            turning = next(values)
            if turning.upper() not in ("VIA", "END"):
                data = {"param": "CIRC_ORI", "expected": "'VIA' or 'END'", "value": f"'{turning}'"}
                raise fail("IRL505", source, given["circ_ori"].span, **data)
        return ArcCourse(via, angle, turning.upper() == "VIA", posture)

    def _target(self, node: tree.Expression, value: RecordValue) -> PoseTarget | JointTarget:
        if value.type == self._type("robtarget"):
            status = value.values[1]
            if isinstance(status, int) and status != 0:
                self._context.machine.warn_once("IRL312", self._context.source, node.span, status=status)
        if value.type in (POSITION, POSE, self._type("robtarget")):
            return pose_target(value)
        return JointTarget(si_values(value, self._context.setting))


def _stops(statement: tree.Move) -> list[tuple[tree.Expression | None, tree.Expression]]:
    """Where the moves of a MOVE end, each with its via point: CIRCLE takes its targets in pairs."""
    targets = statement.targets
    if statement.kind != "CIRCLE":
        return [(None, target) for target in targets]
    return list(zip(targets[::2], targets[1::2], strict=True))
