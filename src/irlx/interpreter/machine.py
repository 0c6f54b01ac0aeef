"""Runs the steps of a program: calls without recursion of Python, bounds for programs that never end."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from typing import Any, TypeAlias

from irlx.blocks import Block, Question
from irlx.diagnostics import Diagnostic, Place, SourceText, Span, report
from irlx.interpreter.code import Code, Frame
from irlx.interpreter.errors import fail
from irlx.interpreter.values import Value

Answer: TypeAlias = "tuple[float, ...] | None"
Caller: TypeAlias = "tuple[Code, Frame, int, int, Span]"
"""Who waits for a call: body, frame, the step to go on with, the slot of the result, and where it calls."""
Blocks: TypeAlias = "Generator[Block | Question, Answer, None]"

MAX_STEPS = 10_000_000
"""Statements that a run may execute unless it is told otherwise."""
MAX_DEPTH = 10_000
"""Calls that may wait for each other."""
MOST_TOLD = 3
"""Calls of which messages tell, from the innermost on."""
MAX_VALUES = 20_000_000
"""Values that the variables of all waiting calls may hold together."""

SWITCH, YIELD, END = -1, -2, -3
"""Signals of a step: go on in another body, yield what is waiting, the program has ended."""


class Machine:
    """State of a running program: waiting calls, and what its steps leave for the generator to yield."""

    def __init__(self, max_steps: int = MAX_STEPS) -> None:
        self._max_steps = max_steps
        self._waiting: list[Caller] = []
        self._values = 0
        self._at: tuple[Code, Frame, int]
        self._blocks: Sequence[Block] = ()
        self._question: Question | None = None
        self._taken: Callable[[tuple[float, ...]], None] = _nothing
        self._next = 0
        self._count = 0
        self.warnings: list[Diagnostic] = []

    def warn_once(self, code: str, source: SourceText, span: Span, **data: Any) -> None:
        """Add a warning of a code, unless there is one."""
        if not any(warning.code == code for warning in self.warnings):
            self.warnings.append(report(code, Place.in_text(source, span), **data))

    def next_id(self) -> int:
        """Number of the next block, counted from 1."""
        self._count += 1
        return self._count

    @property
    def calls(self) -> tuple[Place, ...]:
        """Where the routines that are under way were called, the innermost at most, that one first."""
        # The main statements wait as well, and nobody calls them.
        waiting = self._waiting[1:][: -MOST_TOLD - 1 : -1]
        return tuple(Place.in_text(code.source, span) for code, _, _, _, span in waiting)

    # ---- what steps call

    def emit(self, blocks: Sequence[Block], following: int) -> int:
        """Yield blocks, then go on with the step `following`."""
        self._blocks, self._next = blocks, following
        return YIELD

    def ask(self, question: Question, taken: Callable[[tuple[float, ...]], None], following: int) -> int:
        """Yield a question and give the answer to `taken`, then go on with the step `following`."""
        self._question, self._taken, self._next = question, taken, following
        return YIELD

    def enter(self, code: Code, arguments: Sequence[object], caller: Caller) -> int:
        """Call a body with values of its first slots.

        Raises InterpreterError, IRL511, at the call where too many of them wait for each other.
        """
        waiting = self._waiting
        self._values += code.values
        # The main statements wait as well, and are no call.
        if len(waiting) > MAX_DEPTH or self._values > MAX_VALUES:
            told = {"depth": len(waiting), "most": MAX_DEPTH, "values": self._values, "held": MAX_VALUES}
            raise fail("IRL511", caller[0].source, caller[4], **told)
        waiting.append(caller)
        frame = code.blank.copy()
        frame[: len(arguments)] = arguments
        self._at = (code, frame, 0)
        return SWITCH

    def leave(self, code: Code, value: Value | None) -> int:
        """Go back from a body with the value of a function, or None; from the main one the program ends."""
        if not self._waiting:
            return END
        self._values -= code.values
        caller, frame, following, slot, _ = self._waiting.pop()
        if slot >= 0:
            frame[slot] = value
        self._at = (caller, frame, following)
        return SWITCH

    # ---- the generator

    def run(self, code: Code) -> Blocks:
        """Run a body to its end: yields blocks, and questions whose answers are sent back in.

        Raises InterpreterError with the place of what went wrong.
        """
        left = iter(range(self._max_steps))
        frame, following = code.blank.copy(), 0
        while True:
            following, signal = self._steps(code, frame, following, left)
            if signal == END:
                return
            if signal == SWITCH:
                code, frame, following = self._at
                continue
            following = self._next
            if self._question is not None:
                question, self._question = self._question, None
                self._taken((yield question) or ())
            else:
                yield from self._blocks

    def _steps(self, code: Code, frame: Frame, at: int, left: Iterator[int]) -> tuple[int, int]:
        """Take steps until one gives a signal; that step, and the signal."""
        steps = code.steps
        try:
            for _ in left:
                following = steps[at](frame)
                if following < 0:
                    return at, following
                at = following
        except RecursionError:
            raise fail("IRL513", code.source, code.spans[at]) from None
        raise fail("IRL510", code.source, code.spans[at], most=f"{self._max_steps:,}")


def _nothing(_: tuple[float, ...]) -> None:
    """What becomes of the answer to no question."""
