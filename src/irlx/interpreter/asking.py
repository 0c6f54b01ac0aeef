"""Expressions that only the machine can tell: each is a step that yields a question and keeps the answer."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import ceil, copysign, pi
from typing import TYPE_CHECKING, Any

from irlx.blocks import (
    AskAvoidingPosture,
    AskClearance,
    AskInput,
    AskJointBounds,
    AskLastMove,
    AskManipulability,
    AskNearestPosture,
    AskPose,
    AskPosture,
    AskPostureOf,
    InputBlock,
    Question,
    SignalKind,
)
from irlx.interpreter.base import Base
from irlx.interpreter.code import Frame, Step
from irlx.interpreter.compiled import Compiled, first_failing
from irlx.interpreter.errors import fail
from irlx.interpreter.joints import main_joints, si_values
from irlx.interpreter.obstacles import obstacle_of_cell
from irlx.interpreter.scope import Signal
from irlx.interpreter.targets import origin_of, pose_of_answer, pose_target
from irlx.interpreter.types import POSE, POSITION, REAL, Record, Type, joint_bounds
from irlx.interpreter.values import ArrayValue, RecordValue
from irlx.language import tree
from irlx.language.builtins import ACTUAL_VARIABLES
from irlx.language.obstacles import OBSTACLE_NAME, obstacle_name

if TYPE_CHECKING:
    from irlx.interpreter.expressions import Expressions

_OF_LAST_MOVE: dict[str, tuple[int, float]] = {
    "r_move_time": (0, 1.0),
    "r_distance_back": (1, 1e3),
    "r_distance_forw": (2, 1e3),
}
"""System variables on the last move: which part of the answer they are, and its unit in that of programs."""

Answer = tuple[float, ...]

_SAME_TURN = 1e-9
"""Part of a turn by which rounding may carry a joint beyond 180 degrees."""

UNBOUNDED = 1e30
"""What R_JBD gives, in degrees or mm, for a joint without a bound: REAL holds no infinite numbers."""


class Asking:
    """Compiles what asks, for expressions."""

    def __init__(self, expressions: Expressions) -> None:
        self._expressions = expressions

    def actual(self, node: tree.Designator) -> Compiled:
        """R_JOINT_ACT and its like, or a part of it. Raises InterpreterError."""
        context, key = self._expressions.context, node.base.key
        if key in _OF_LAST_MOVE:
            return self._of_last_move(node, *_OF_LAST_MOVE[key])
        if key == "r_jbd":
            return self._bounds(node)
        type = self._type("joint" if key == "r_joint_act" else "robtarget")
        way = self._expressions.designators.way(node, type)
        self._machine_for(node.base)
        asked = AskPosture(origin_of(context.source, node))
        posture = self._ask(node, lambda _: asked, lambda answer: answer)
        if key == "r_joint_act":
            main = self._type("main_joint")
            (empty,) = context.rest["JOINT"]

            def joint(frame: Frame) -> RecordValue:
                return RecordValue(type, (main_joints(main, posture(frame), context.setting), empty))

            return self._expressions.designators.part(node, joint, way)
        return self._expressions.designators.part(node, self._robtarget(node, type, posture), way)

    def _of_last_move(self, node: tree.Designator, part: int, unit: float) -> Compiled:
        """R_MOVE_TIME, R_DISTANCE_BACK and R_DISTANCE_FORW."""
        way = self._expressions.designators.way(node, REAL)
        self._machine_for(node.base)
        asked = AskLastMove(origin_of(self._expressions.source, node))
        value = self._ask(node, lambda _: asked, lambda answer: answer[part] * unit)
        return self._expressions.designators.part(node, value, way)

    def _bounds(self, node: tree.Designator) -> Compiled:
        """R_JBD: the bounds of all joints."""
        context = self._expressions.context
        lower, upper = self._type("main_joint_min"), self._type("main_joint_max")
        type = joint_bounds({"main_joint_min": lower, "main_joint_max": upper})
        way = self._expressions.designators.way(node, type)
        self._machine_for(node.base)
        asked = AskJointBounds(origin_of(context.source, node))

        def bounds(answer: Answer) -> RecordValue:
            half = len(answer) // 2
            sides = ((lower, answer[:half]), (upper, answer[half:]))
            found = (main_joints(side, values, context.setting) for side, values in sides)
            return RecordValue(type, tuple(map(_bounded, found)))

        return self._expressions.designators.part(node, self._ask(node, lambda _: asked, bounds), way)

    def _robtarget(self, node: tree.Node, type: Record, posture: Callable[[Frame], Answer]) -> Any:
        """The target that the tool is at: pose and turns of the posture; nothing is known of its status."""
        context = self._expressions.context
        origin, slides = origin_of(context.source, node), context.setting.prismatic
        pose = self._ask(node, lambda frame: AskPose(origin, posture(frame)), self._pose(node))
        _, turns, empty = context.rest["ROBTARGET"]
        if not isinstance(turns, ArrayValue):
            raise TypeError("turns come in an array")

        def robtarget(frame: Frame) -> RecordValue:
            values = zip(posture(frame), slides, strict=True)
            counted = [0 if slide else _turns(value) for value, slide in values]
            return RecordValue(type, (pose(frame), 0, ArrayValue(turns.type, [*counted]), empty))

        return robtarget

    def input(self, node: tree.Designator, signal: Signal) -> Compiled:
        """The value of an input at that moment; what was read becomes a block. Raises InterpreterError."""
        context = self._expressions.context
        self._machine_for(node.base)
        machine, origin, port = context.machine, origin_of(context.source, node), signal.port
        asked = AskInput(origin, port, (signal.name, port.name))
        value = self._ask(node, lambda _: asked, lambda answer: answer[0])
        assembler = context.assembler
        assert assembler is not None

        def make(following: int) -> Step:
            def step(frame: Frame) -> int:
                block = InputBlock(id=machine.next_id(), origin=origin, port=port, value=value(frame))
                return machine.emit((block,), following)

            return step

        assembler.add(node, make)
        to: Callable[[float], Any] = {SignalKind.BOOL: bool, SignalKind.INT: int}.get(port.kind, float)
        return Compiled(signal.type, lambda frame: to(value(frame)))

    def call(self, name: tree.Name, given: Sequence[tree.Expression], node: tree.Node) -> Compiled:
        """A function that asks. Raises InterpreterError: IRL228, IRL222, IRL573, IRL590."""
        self._machine_for(name)
        if name.key == "clearance" or (name.key == "posture" and len(given) != 1):
            return self._about_obstacle(name.key, given, node)
        main, joint = self._type("main_joint"), self._type("joint")
        postures, places = (main, joint), (POSE, POSITION)
        types = {
            "posture": (places,),
            "ik": (places, postures),
            "fk": (postures,),
            "manipulability": (postures,),
        }[name.key]
        parts = self._expressions.arguments(name.key.upper(), types, given, node)
        wrong = first_failing(parts)
        if wrong is not None:
            return wrong
        runs = [part.run for part in parts]
        if name.key in ("posture", "ik"):
            return self._posture(node, runs, main)
        return self._of_posture(name.key, node, runs[0])

    def _posture(self, node: tree.Node, runs: Sequence[Callable[[Frame], Any]], main: Record) -> Compiled:
        """POSTURE and IK: a posture of a pose."""
        context = self._expressions.context
        base = Base(context, node)
        origin, setting = origin_of(context.source, node), context.setting

        def question(frame: Frame) -> Question:
            target = pose_target(runs[0](frame), base)
            if len(runs) == 1:
                return AskPostureOf(origin, target.position, target.orientation)
            near = si_values(runs[1](frame), setting)
            return AskNearestPosture(origin, target.position, target.orientation, near)

        found = self._ask(node, question, lambda answer: main_joints(main, answer, setting))
        return Compiled(main, found)

    def _about_obstacle(self, key: str, given: Sequence[tree.Expression], node: tree.Node) -> Compiled:
        """CLEARANCE, and POSTURE with an obstacle. Raises InterpreterError: IRL228, IRL222, IRL573."""
        context, main, joint = self._expressions.context, self._type("main_joint"), self._type("joint")
        if len(given) != 2:
            expected = "2 values" if key == "clearance" else "1 or 2 values"
            data = {"function": key.upper(), "expected": expected, "found": len(given)}
            raise fail("IRL228", context.source, node.span, **data)
        types = (main, joint) if key == "clearance" else (POSE, POSITION)
        (what,) = self._expressions.arguments(key.upper(), (types,), given[:1], node)
        wrong = first_failing((what,))
        if wrong is not None:
            return wrong
        name = obstacle_name(given[1])
        if name is None:
            data = {"expected": OBSTACLE_NAME, "found": "an expression"}
            raise fail("IRL222", context.source, given[1].span, **data)
        cell_name, setting = obstacle_of_cell(name, context), context.setting
        origin, base = origin_of(context.source, node), Base(context, node)

        def clearance(frame: Frame) -> Question:
            return AskClearance(origin, si_values(what.run(frame), setting), cell_name)

        def avoiding(frame: Frame) -> Question:
            target = pose_target(what.run(frame), base)
            return AskAvoidingPosture(origin, target.position, target.orientation, cell_name)

        if key == "clearance":
            return Compiled(REAL, self._ask(node, clearance, lambda answer: answer[0] * 1e3))
        return Compiled(main, self._ask(node, avoiding, lambda answer: main_joints(main, answer, setting)))

    def _of_posture(self, key: str, node: tree.Node, run: Callable[[Frame], Any]) -> Compiled:
        """FK and MANIPULABILITY: what a posture is like."""
        context = self._expressions.context
        origin, setting = origin_of(context.source, node), context.setting
        kind = AskPose if key == "fk" else AskManipulability

        def question(frame: Frame) -> Question:
            return kind(origin, si_values(run(frame), setting))

        if key == "fk":
            return Compiled(POSE, self._ask(node, question, self._pose(node)))
        return Compiled(REAL, self._ask(node, question, lambda answer: answer[0]))

    # ---- steps

    def _machine_for(self, name: tree.Name) -> None:
        """Raises InterpreterError, IRL590, in constants, which come before there is a machine to ask."""
        if self._expressions.context.assembler is None:
            kind = "system variable" if name.key in ACTUAL_VARIABLES else "function"
            what = f"the {kind} {name.name} in a constant"
            raise fail("IRL590", self._expressions.source, name.span, what=what)

    def _ask(
        self, node: tree.Node, question: Callable[[Frame], Question], meaning: Callable[[Answer], Any]
    ) -> Callable[[Frame], Any]:
        """Add a step that asks; what gives the answer's meaning afterwards."""
        context = self._expressions.context
        assembler, machine = context.assembler, context.machine
        if assembler is None:
            raise TypeError("constants do not ask")
        slot = assembler.slot()

        def make(following: int) -> Step:
            def step(frame: Frame) -> int:
                def taken(answer: Answer) -> None:
                    frame[slot] = meaning(answer)

                return machine.ask(question(frame), taken, following)

            return step

        assembler.add(node, make)
        return lambda frame: frame[slot]

    def _pose(self, node: tree.Node) -> Callable[[Answer], RecordValue]:
        """What gives the POSE of an answer as the program has it."""
        base = Base(self._expressions.context, node)
        return lambda answer: pose_of_answer(answer, base)

    def _type(self, key: str) -> Record:
        found: Type | None = self._expressions.scope.type(key)
        if not isinstance(found, Record):
            raise TypeError("joint types are records")
        return found


def _bounded(side: RecordValue) -> RecordValue:
    """Bounds without infinite numbers."""
    return RecordValue(side.type, tuple(max(-UNBOUNDED, min(UNBOUNDED, real)) for real in side.reals()))


def _turns(angle: float) -> int:
    """Whole turns of a joint beyond +-180 degrees: none up to there, one from there to +-540 degrees; rad."""
    beyond = ceil((abs(angle) - pi) / (2 * pi) - _SAME_TURN)
    return int(copysign(max(beyond, 0), angle))
