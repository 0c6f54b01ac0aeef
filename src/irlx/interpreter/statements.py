"""Statements: program tree -> steps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from irlx.blocks import HaltBlock, SignalBlock
from irlx.interpreter.calls import Calls
from irlx.interpreter.cases import add_case
from irlx.interpreter.channel_statements import add_channel_call
from irlx.interpreter.code import Frame, Label, Step
from irlx.interpreter.compiled import Run, failing
from irlx.interpreter.context import Context
from irlx.interpreter.errors import InterpreterError, fail
from irlx.interpreter.expressions import Expressions
from irlx.interpreter.loops import add_for
from irlx.interpreter.machine import END
from irlx.interpreter.motion import Motion
from irlx.interpreter.robot_variables import add_change
from irlx.interpreter.scope import Followed, Routine, Signal
from irlx.interpreter.support import part_name
from irlx.interpreter.targets import origin_of
from irlx.interpreter.types import BOOL, Type
from irlx.interpreter.waits import add_pause, add_wait, add_wait_for
from irlx.language import tree
from irlx.language.builtins import PROCEDURES


class Statements:
    """Compiles the statements of one body; `result` is the type of a function's value, None elsewhere.

    What is wrong with a statement is told when the program gets there: its step raises the error.
    """

    def __init__(self, context: Context, result: Type | None = None) -> None:
        if context.assembler is None:
            raise TypeError("statements become steps")
        self.context = context
        self.assembler = context.assembler
        self.expressions = Expressions(context)
        self._result = result
        self._motion = Motion(self.expressions, self.assembler)
        self._labels: dict[str, Label] = {}
        self._exits: list[Label] = []

    def body(self, statements: Sequence[tree.Statement]) -> None:
        """Add the steps of a body and of all bodies inside it."""
        for statement in statements:
            if isinstance(statement, tree.Label):
                self._labels.setdefault(statement.name.key, Label())
        for statement in statements:
            self.add(statement)

    def add(self, statement: tree.Statement) -> None:
        """Add the steps of a statement."""
        mark = self.assembler.mark
        try:
            self._add(statement)
        except InterpreterError as error:
            wrong = error
        except RecursionError:
            wrong = fail("IRL513", self.context.source, statement.span)
        else:
            return
        self.assembler.undo(mark)
        self.run(statement, failing(wrong).run)

    def run(self, node: tree.Node, run: Callable[[Frame], Any]) -> None:
        """Add a step that does something and goes on."""

        def make(following: int) -> Step:
            def step(frame: Frame) -> int:
                run(frame)
                return following

            return step

        self.assembler.add(node, make)

    def _add(self, statement: tree.Statement) -> None:
        add = _ADDERS.get(type(statement))
        if add is not None:
            add(self, statement)
        elif not self._motion.add(statement):
            raise fail("IRL590", self.context.source, statement.span, what=part_name(statement))

    # ---- assignment, calls

    def _assignment(self, node: tree.Assignment) -> None:
        signal = self.expressions.designators.signal(node.target.base)
        if signal is not None and not signal.is_input and not node.target.selectors:
            self._set_output(signal, node)
            return
        stored = self.context.scope.found(node.target.base.key)
        if isinstance(stored, Followed):
            add_change(self, node, stored)
        else:
            self.assign(node.target, node.value, node)

    def _set_output(self, signal: Signal, node: tree.Assignment) -> None:
        """Add the steps that set an output: its value is remembered, and becomes a block."""
        machine, origin = self.context.machine, origin_of(self.context.source, node)
        run, port = self.expressions.value(node.value, signal.type).run, signal.port

        def make(following: int) -> Step:
            def step(frame: Frame) -> int:
                value = run(frame)
                signal.value = value
                block = SignalBlock(id=machine.next_id(), origin=origin, port=port, value=float(value))
                return machine.emit((block,), following)

            return step

        self.assembler.add(node, make)

    def assign(self, target: tree.Designator, value: tree.Expression, node: tree.Node) -> None:
        """Add the steps of an assignment; the place is found before the value."""
        keep = self.expressions.suspends(value)
        type, set_, find = self.expressions.designators.setter(target, keep=keep)
        run = self.expressions.value(value, type).run

        def make(following: int) -> Step:
            def step(frame: Frame) -> int:
                try:
                    found = run(frame)
                except InterpreterError:
                    # Where the place is wrong as well it is told: it stands further left.
                    if find is not None:
                        find(frame)
                    raise
                set_(frame, found)
                return following

            return step

        self.assembler.add(node, make)

    def _call(self, node: tree.Call) -> None:
        routine = self.context.scope.found(node.name.key)
        source = self.context.source
        if not isinstance(routine, Routine):
            if routine is None and node.name.key in PROCEDURES:
                add_channel_call(self, node)
                return
            if routine is None:
                raise fail("IRL590", source, node.span, what=f"the procedure {node.name.name}")
            found = f"the variable {routine.name}"
            raise fail("IRL222", source, node.span, expected="a procedure", found=found)
        arguments = [a for a in node.arguments if not isinstance(a, tree.FormattedValue)]
        if len(arguments) != len(node.arguments):
            data = {"expected": "a value without a layout", "found": "one with :width"}
            raise fail("IRL222", source, node.span, **data)
        wrong = Calls(self.expressions).call(routine, arguments, node)
        if wrong is not None:
            self.run(node, wrong.run)

    def _return(self, node: tree.Return) -> None:
        machine, code = self.context.machine, self.assembler.code
        run: Run = _no_value
        if node.value is not None and self._result is not None:
            run = self.expressions.value(node.value, self._result).run
        elif node.value is not None or self._result is not None:
            need = "needs the value of the function" if self._result else "has no value outside of a function"
            raise fail("IRL514", self.context.source, node.span, need=need)
        self.assembler.add(node, lambda _: lambda frame: machine.leave(code, run(frame)))

    def end(self, node: tree.Node) -> None:
        """Add what is behind the last statement: the body is left, a function has no value there."""
        machine, code = self.context.machine, self.assembler.code
        if self._result is None:
            self.assembler.add(node, lambda _: lambda _: machine.leave(code, None))
        else:
            error = fail("IRL514", self.context.source, node.span, need="must end the function with a value")
            self.run(node, failing(error).run)

    # ---- jumps

    def _label(self, node: tree.Label) -> None:
        self.assembler.place(self._labels[node.name.key])

    def _goto(self, node: tree.Goto) -> None:
        label = self._labels.get(node.label.key)
        if label is None:
            raise fail("IRL215", self.context.source, node.label.span, name=node.label.name, near="")
        # A step of its own: a jump back to itself must count.
        self.assembler.add(node, lambda _, target: lambda _: target, label)

    def _exit(self, node: tree.Exit) -> None:
        if not self._exits:
            raise fail("IRL217", self.context.source, node.span)
        self.assembler.jump(node, self._exits[-1])

    # ---- IF, CASE

    def test(self, condition: tree.Expression, node: tree.Node, no: Label) -> None:
        """Add a step that goes to `no` where a condition is false."""
        found = self.expressions.value(condition, BOOL)
        run = found.run

        def make(following: int, no: int) -> Step:
            return lambda frame: following if run(frame) else no

        self.assembler.add(node, make, no)

    def _if(self, node: tree.If) -> None:
        end = Label()
        for branch in node.branches:
            no = Label()
            self.test(branch.condition, branch.condition, no)
            self.body(branch.body)
            self.assembler.jump(node, end)
            self.assembler.place(no)
        self.body(node.otherwise or ())
        self.assembler.place(end)

    # ---- loops

    def loop(self, body: Sequence[tree.Statement], end: Label) -> None:
        """Add the statements of a loop; EXIT goes to `end`."""
        self._exits.append(end)
        self.body(body)
        self._exits.pop()

    def _while(self, node: tree.While) -> None:
        again, end = Label(), Label()
        self.assembler.place(again)
        self.test(node.condition, node.condition, end)
        self.loop(node.body, end)
        self.assembler.jump(node, again)
        self.assembler.place(end)

    def _repeat(self, node: tree.Repeat) -> None:
        again, end = Label(), Label()
        self.assembler.place(again)
        self.loop(node.body, end)
        self.test(node.condition, node.condition, again)
        self.assembler.place(end)

    # ---- rest

    def _halt(self, node: tree.Halt) -> None:
        machine, origin = self.context.machine, origin_of(self.context.source, node)

        def make(following: int) -> Step:
            return lambda _: machine.emit((HaltBlock(id=machine.next_id(), origin=origin),), following)

        self.assembler.add(node, make)
        self.assembler.add(node, lambda _: lambda _: END)


def _no_value(_: Frame) -> None:
    """What a procedure gives back."""


_ADDERS: dict[type[tree.Node], Any] = {
    tree.Assignment: Statements._assignment,
    tree.Call: Statements._call,
    tree.Return: Statements._return,
    tree.Label: Statements._label,
    tree.Goto: Statements._goto,
    tree.Exit: Statements._exit,
    tree.If: Statements._if,
    tree.Case: add_case,
    tree.For: add_for,
    tree.While: Statements._while,
    tree.Repeat: Statements._repeat,
    tree.Halt: Statements._halt,
    tree.Pause: add_pause,
    tree.WaitTime: add_wait,
    tree.WaitFor: add_wait_for,
}
