"""WAIT, WAIT FOR and PAUSE: statements that let time pass while the robot stands."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import TYPE_CHECKING

from irlx.blocks import AskInputChange, AskPause, PauseBlock, WaitBlock
from irlx.interpreter.code import Frame, Label, Step
from irlx.interpreter.errors import fail
from irlx.interpreter.signals import watched
from irlx.interpreter.targets import origin_of
from irlx.interpreter.types import BOOL, REAL
from irlx.language import tree

if TYPE_CHECKING:
    from irlx.interpreter.statements import Statements

LONGEST_WAIT = 3600.0
"""Time, s, that a WAIT FOR without TIMEOUT may take."""
_NOTHING_LEFT = 1e-9


def add_wait(statements: Statements, node: tree.WaitTime) -> None:
    """Add the steps of WAIT t SEC. IRL505 when run for less than 0."""
    machine, source = statements.context.machine, statements.context.source
    duration, origin = _duration(statements, node.duration, "WAIT"), origin_of(source, node)

    def make(following: int) -> Step:
        def step(frame: Frame) -> int:
            block = WaitBlock(id=machine.next_id(), origin=origin, duration=duration(frame))
            return machine.emit((block,), following)

        return step

    statements.assembler.add(node, make)


def add_pause(statements: Statements, node: tree.Pause) -> None:
    """Add the steps of PAUSE: ask how long it lasts, and stand for that time."""
    assembler, machine = statements.assembler, statements.context.machine
    origin, lasts = origin_of(statements.context.source, node), assembler.slot()
    asked = AskPause(origin)

    def ask(following: int) -> Step:
        def step(frame: Frame) -> int:
            def taken(answer: tuple[float, ...]) -> None:
                frame[lasts] = answer[0]

            return machine.ask(asked, taken, following)

        return step

    def stand(following: int) -> Step:
        def step(frame: Frame) -> int:
            block = PauseBlock(id=machine.next_id(), origin=origin, duration=frame[lasts])
            return machine.emit((block,), following)

        return step

    assembler.add(node, ask)
    assembler.add(node, stand)


def add_wait_for(statements: Statements, node: tree.WaitFor) -> None:
    """Add the steps of WAIT FOR: look; while it is not true wait for an input to change, or the time to end.

    IRL532 when run where no input that it reads ever changes any more, IRL533 where it takes too long.
    """
    assembler, expressions, machine = statements.assembler, statements.expressions, statements.context.machine
    source, again, end = statements.context.source, Label(), Label()
    words = " ".join(source.text[node.condition.span.start : node.condition.span.end].split())
    origin, left, change = origin_of(source, node), assembler.slot(inf), assembler.slot()
    limit = None if node.timeout is None else _duration(statements, node.timeout, "TIMEOUT")

    def begin(frame: Frame) -> None:
        frame[left] = LONGEST_WAIT if limit is None else limit(frame)

    statements.run(node, begin)
    assembler.place(again)
    asked = AskInputChange(origin, watched(node.condition, expressions).inputs)
    condition = expressions.value(node.condition, BOOL).run

    def look(following: int, end: int) -> Step:
        def step(frame: Frame) -> int:
            if condition(frame) or (limit is not None and frame[left] <= _NOTHING_LEFT):
                return end

            def taken(answer: tuple[float, ...]) -> None:
                frame[change] = answer[0] if answer else inf

            return machine.ask(asked, taken, following)

        return step

    def wait(following: int, again: int) -> Step:
        def step(frame: Frame) -> int:
            if limit is None and frame[change] == inf:
                raise fail("IRL532", source, node.span, condition=words)
            if limit is None and frame[left] <= _NOTHING_LEFT:
                raise fail("IRL533", source, node.span, condition=words, waited=f"{LONGEST_WAIT:g}")
            duration = min(frame[change], frame[left])
            frame[left] -= duration
            block = WaitBlock(id=machine.next_id(), origin=origin, duration=duration, condition=words)
            return machine.emit((block,), again)

        return step

    assembler.add(node, look, end)
    assembler.add(node, wait, again)
    assembler.place(end)


def _duration(statements: Statements, node: tree.Expression, name: str) -> Callable[[Frame], float]:
    """A time in s, not negative."""
    source, run = statements.context.source, statements.expressions.value(node, REAL).run

    def duration(frame: Frame) -> float:
        value = float(run(frame))
        if not value >= 0.0:
            data = {"param": name, "expected": "0 or more", "value": f"{value:g}"}
            raise fail("IRL505", source, node.span, **data)
        return value

    return duration
