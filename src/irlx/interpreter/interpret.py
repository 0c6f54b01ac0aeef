"""Statements: program tree -> blocks."""

from __future__ import annotations

from collections.abc import Generator, Iterator, Sequence
from math import radians

from irlx.blocks import (
    ArcCourse,
    AskPosture,
    AskPostureOf,
    Block,
    CriterionBlock,
    CriterionClause,
    CyclicBlock,
    FreezeBlock,
    HaltBlock,
    JointRange,
    JointTarget,
    LimitClause,
    LimitKind,
    LimitSwitchBlock,
    MotionLaw,
    MoveBlock,
    MoveKind,
    Origin,
    PoseTarget,
    Question,
    ReconfigureBlock,
)
from irlx.diagnostics import SourceText
from irlx.interpreter.declare import declared_scope
from irlx.interpreter.errors import fail
from irlx.interpreter.evaluate import Evaluator, replaced
from irlx.interpreter.parameters import criterion_choice, criterion_name, positive, share
from irlx.interpreter.scope import Variable
from irlx.interpreter.setting import Setting
from irlx.interpreter.support import MOVE_PARAMS, missing_in_move, part_name, reads_actual
from irlx.interpreter.targets import origin_of, pose_target
from irlx.interpreter.types import POSE, POSITION, STRING, Record, Type
from irlx.interpreter.unanswered import Unanswered
from irlx.interpreter.values import RecordValue, Value, is_set
from irlx.language import tree
from irlx.language.data_lists import ImportedList

Answer = tuple[float, ...] | None
Blocks = Generator[Block | Question, Answer, None]

_LIMIT_TYPES = {
    "POSITION": ("main_joint_min", "main_joint_max"),
    "SPEED": ("main_joint_speed_min", "main_joint_speed_max"),
    "ACCELERATION": ("main_joint_accel_min", "main_joint_accel_max"),
}


def interpret(
    program: tree.Program, source: SourceText, setting: Setting, lists: Sequence[ImportedList] = ()
) -> Blocks:
    """Run a program: yields its blocks in order, and questions whose answers are sent back in.

    `lists` are the data lists that it imports. Raises InterpreterError at the statement that goes wrong; the
    blocks before it stay valid.
    """
    return _Interpreter(program, source, setting, lists).run()


class _Interpreter:
    def __init__(
        self, program: tree.Program, source: SourceText, setting: Setting, lists: Sequence[ImportedList]
    ) -> None:
        self._program = program
        self._source = source
        self._setting = setting
        self._scope = declared_scope(program, source, setting, lists)
        self._answers: dict[AskPostureOf, Value] = {}
        self._evaluator = Evaluator(source, self._scope, self._answers)
        self._blocks = 0

    def run(self) -> Blocks:
        for statement in self._program.body:
            if reads_actual(statement):
                answer = yield AskPosture(self._origin(statement))
                self._set_actual(answer or ())
            yield from (yield from self._answered(statement))
            if isinstance(statement, tree.Halt):
                return

    def _answered(self, statement: tree.Statement) -> Generator[Question, Answer, list[Block]]:
        """Blocks of a statement. What only the machine can tell is asked, and all evaluated again:
        expressions change nothing, and an assignment happens once everything has a value."""
        self._answers.clear()
        number = self._blocks
        while True:
            try:
                return self._blocks_of(statement)
            except Unanswered as unanswered:
                self._blocks = number
                question = unanswered.question
            self._answers[question] = self._main_joints((yield question) or ())

    def _blocks_of(self, statement: tree.Statement) -> list[Block]:
        """Blocks of a statement in their order; an assignment has none."""
        match statement:
            case tree.Assignment():
                self._assign(statement)
                return []
            case tree.Move():
                return list(self._move(statement))
            case tree.Reconfiguration():
                return [self._reconfigure(statement)]
            case tree.Halt():
                return [HaltBlock(id=self._next_id(), origin=self._origin(statement))]
        return [self._switch(statement)]

    # ---- bookkeeping

    def _next_id(self) -> int:
        self._blocks += 1
        return self._blocks

    def _origin(self, node: tree.Node, last: tree.Node | None = None) -> Origin:
        return origin_of(self._source, node, last)

    def _set_actual(self, joints: tuple[float, ...]) -> None:
        """Store the posture (rad, m) in R_JOINT_ACT (deg, mm)."""
        variable = self._scope.variables["r_joint_act"]
        variable.value = replaced(variable.value, [0], self._main_joints(joints))

    def _main_joints(self, joints: tuple[float, ...]) -> RecordValue:
        """MAIN_JOINT (deg, mm) of a posture (rad, m)."""
        type = self._scope.types["main_joint"]
        if not isinstance(type, Record):
            raise TypeError("joint types are records")
        return RecordValue(type, tuple(value / self._unit(index) for index, value in enumerate(joints)))

    def _unit(self, joint: int) -> float:
        """Size of the program's unit of a joint in SI: mm in m, or degree in rad."""
        return 1e-3 if self._setting.prismatic[joint] else radians(1.0)

    def _si(self, joint: int, value: float) -> float:
        return value * 1e-3 if self._setting.prismatic[joint] else radians(value)

    # ---- statements

    def _assign(self, statement: tree.Assignment) -> None:
        variable = self._evaluator.variable(statement.target.base)
        if variable.constant:
            raise fail("IRL211", self._source, statement.target.span, name=variable.name, kind="a constant")
        steps = self._evaluator.steps(statement.target)
        value = self._evaluator.value(statement.value, _part_type(variable, steps))
        variable.value = replaced(variable.value, steps, value)

    def _switch(self, statement: tree.Statement) -> Block:
        origin, id = self._origin(statement), self._next_id()
        match statement:
            case tree.LimitSwitch():
                joint_range = self._range(statement.kind, statement.lower, statement.upper)
                return LimitSwitchBlock(
                    id=id, origin=origin, kind=LimitKind(statement.kind), range=joint_range
                )
            case tree.LimitSwitchEnd():
                return LimitSwitchBlock(id=id, origin=origin, kind=LimitKind(statement.kind), range=None)
            case tree.FreezeStart():
                joints = tuple(self._evaluator.whole(joint) for joint in statement.joints)
                return FreezeBlock(id=id, origin=origin, joints=joints)
            case tree.FreezeEnd():
                return FreezeBlock(id=id, origin=origin, joints=())
            case tree.CyclicStart():
                return CyclicBlock(id=id, origin=origin, active=True)
            case tree.CyclicEnd():
                return CyclicBlock(id=id, origin=origin, active=False)
            case tree.CriterionStart():
                choice = criterion_choice(statement, self._evaluator)
                return CriterionBlock(id=id, origin=origin, name=choice.name, choice=choice)
            case tree.CriterionEnd(name=name):
                return CriterionBlock(id=id, origin=origin, name=criterion_name(name), choice=None)
            case _:
                raise fail("IRL590", self._source, statement.span, what=part_name(statement))

    def _range(self, kind: str, lower: tree.Expression, upper: tree.Expression) -> JointRange:
        types = tuple(self._scope.types[key] for key in _LIMIT_TYPES[kind])
        bounds = []
        for expression, type in zip((lower, upper), types, strict=True):
            value = self._evaluator.value(expression, type)
            bounds.append(self._joint_values(value))
        return JointRange(*bounds)

    def _joint_values(self, value: Value) -> tuple[float, ...]:
        if not isinstance(value, RecordValue):
            raise TypeError("joint values come in a record")
        return tuple(self._si(index, real) for index, real in enumerate(value.reals()))

    # ---- moves

    def _move(self, statement: tree.Move) -> Iterator[Block]:
        missing = missing_in_move(statement)
        if missing is not None:
            node, what = missing
            raise fail("IRL590", self._source, node.span, what=what)
        law = self._law(statement)
        limits = tuple(
            LimitClause(LimitKind(clause.kind), self._range(clause.kind, clause.lower, clause.upper), origin)
            for clause in statement.clauses
            if isinstance(clause, tree.WithLimit)
            for origin in (self._origin(clause),)
        )
        criteria = tuple(
            CriterionClause(criterion_choice(clause, self._evaluator), self._origin(clause))
            for clause in statement.clauses
            if isinstance(clause, tree.WithCriterion)
        )
        stops = _stops(statement)
        for (via, expression), postures in zip(stops, self._postures(statement, len(stops)), strict=True):
            target = self._target(expression)
            origin = (
                self._origin(via or expression, expression) if len(stops) > 1 else self._origin(statement)
            )
            yield MoveBlock(
                id=self._next_id(),
                origin=origin,
                kind=MoveKind(statement.kind),
                target=target,
                law=law,
                limits=limits,
                course=None if via is None else self._course(statement, via, postures[0]),
                reconfiguration=postures[1],
                criteria=criteria,
            )

    def _postures(
        self, statement: tree.Move, moves: int
    ) -> list[tuple[JointTarget | None, JointTarget | None]]:
        """Postures of WITH RECONFIGURATION, at the via point and at the end of each move of a MOVE.

        A CIRCLE has one for each target, or one for each end point.
        """
        for clause in statement.clauses:
            if isinstance(clause, tree.WithReconfiguration):
                postures = [self._posture(expression) for expression in clause.targets]
                if len(postures) == moves:
                    return [(None, posture) for posture in postures]
                return list(zip(postures[::2], postures[1::2], strict=True))
        return [(None, None)] * moves

    def _posture(self, expression: tree.Expression) -> JointTarget:
        main, joint = self._scope.types["main_joint"], self._scope.types["joint"]
        value = self._evaluator.one_of(expression, (main, joint))
        if not isinstance(value, RecordValue):
            raise TypeError("postures are records")
        return JointTarget(self._joint_values(value.values[0] if value.type == joint else value))

    def _reconfigure(self, statement: tree.Reconfiguration) -> Block:
        target, law = self._posture(statement.target), self._law(statement)
        return ReconfigureBlock(id=self._next_id(), origin=self._origin(statement), target=target, law=law)

    def _course(self, statement: tree.Move, via: tree.Expression, posture: JointTarget | None) -> ArcCourse:
        """Via point of a CIRCLE, its posture where it has one, with what ANGLE and CIRC_ORI say."""
        given = {param.name.key: param.value for param in statement.params}
        angle, turning = None, "END"
        if "angle" in given:
            angle = radians(self._evaluator.number(given["angle"]))
            if angle == 0.0:
                data = {"param": "ANGLE", "expected": "other than 0", "value": "0"}
                raise fail("IRL505", self._source, given["angle"].span, **data)
        if "circ_ori" in given:
            turning = str(self._evaluator.value(given["circ_ori"], STRING))
            if turning.upper() not in ("VIA", "END"):
                data = {"param": "CIRC_ORI", "expected": "'VIA' or 'END'", "value": f"'{turning}'"}
                raise fail("IRL505", self._source, given["circ_ori"].span, **data)
        return ArcCourse(self._target(via), angle, turning.upper() == "VIA", posture)

    def _target(self, expression: tree.Expression) -> PoseTarget | JointTarget:
        main, joint = self._scope.types["main_joint"], self._scope.types["joint"]
        value = self._evaluator.one_of(expression, (POSE, POSITION, main, joint))
        if not isinstance(value, RecordValue):
            raise TypeError("targets are records")
        if value.type in (POSITION, POSE):
            return pose_target(value)
        return JointTarget(self._joint_values(value.values[0] if value.type == joint else value))

    def _law(self, statement: tree.Move | tree.Reconfiguration) -> MotionLaw:
        params = statement.params if isinstance(statement, tree.Move) else ()
        given = {param.name.key: param.value for param in params}

        def real(param: str) -> float:
            expression = given.get(param)
            if expression is not None:
                value = self._evaluator.number(expression)
                return positive(param.upper(), value, expression, self._source)
            variable = self._scope.variables[MOVE_PARAMS[param].casefold()]
            if not isinstance(variable.value, float) or not is_set(variable.value):
                raise TypeError("system variables are numbers")
            return positive(variable.name, variable.value, statement, self._source)

        def part(param: str) -> float:
            return share(param.upper(), real(param), given.get(param, statement), self._source)

        duration = None
        if "time" in given:
            value = self._evaluator.number(given["time"])
            duration = positive("TIME", value, given["time"], self._source)
        return MotionLaw(
            speed=real("speed") * 1e-3,
            acc=real("acc") * 1e-3,
            speed_ori=radians(real("speed_ori")),
            acc_ori=radians(real("acc_ori")),
            speed_ptp=part("speed_ptp"),
            acc_ptp=part("acc_ptp"),
            duration=duration,
        )


def _stops(statement: tree.Move) -> list[tuple[tree.Expression | None, tree.Expression]]:
    """Where the moves of a MOVE end, each with its via point: CIRCLE takes its targets in pairs."""
    targets = statement.targets
    if statement.kind != "CIRCLE":
        return [(None, target) for target in targets]
    return list(zip(targets[::2], targets[1::2], strict=True))


def _part_type(variable: Variable, steps: list[int]) -> Type:
    """Type of the part of a variable that `steps` lead to."""
    type = variable.type
    for step in steps:
        type = type.fields[step][1] if isinstance(type, Record) else type.element  # type: ignore[union-attr]
    return type
