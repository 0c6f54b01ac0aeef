"""An expression, compiled: its type, and a function that gives its value in the frame of a call."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from irlx.interpreter.code import Frame
from irlx.interpreter.errors import InterpreterError
from irlx.interpreter.types import Type

Run: TypeAlias = "Callable[[Frame], Any]"
"""Gives a value; raises InterpreterError at the part that has none."""


@dataclass(frozen=True)
class Compiled:
    """What an expression means. `type` is None for one that never has a value: `run` raises `error`.

    `constant` ones have the same value in every frame; `text` is that of a literal text.
    """

    type: Type | None
    run: Run
    error: InterpreterError | None = None
    constant: bool = False
    text: str | None = None


def constant(type: Type, value: Any, text: str | None = None) -> Compiled:
    """An expression that always has this value."""
    return Compiled(type, lambda _: value, constant=True, text=text)


def folded(type: Type, run: Run, *parts: Compiled) -> Compiled:
    """An expression of parts: where all are constant it is evaluated once, unless it has no value."""
    if all(part.constant for part in parts):
        try:
            return constant(type, run([]))
        except InterpreterError:
            # Told when the program gets there.
            pass
    return Compiled(type, run)


def failing(error: InterpreterError, before: Sequence[Compiled] = ()) -> Compiled:
    """An expression that is wrong in itself, told when it is run; parts that come `before` are run first."""
    runs = tuple(part.run for part in before)

    def run(frame: Frame) -> Any:
        for part in runs:
            part(frame)
        # A new one each time: an error keeps the frames that it came through.
        raise InterpreterError(error.reason)

    return Compiled(None, run, error)


def first_failing(parts: Sequence[Compiled]) -> Compiled | None:
    """An expression for parts of which one never has a value: that one, those before it run first."""
    for at, part in enumerate(parts):
        if part.type is None and part.error is not None:
            return failing(part.error, (*parts[:at], part))
    return None
