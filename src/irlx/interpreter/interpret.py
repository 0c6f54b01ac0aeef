"""A program and its modules: tree -> blocks."""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from irlx.diagnostics import Diagnostic, Place, SourceText
from irlx.interpreter.channels.channels import Channels
from irlx.interpreter.code import Code, Step
from irlx.interpreter.declare import Unit
from irlx.interpreter.list_text import Rewritten
from irlx.interpreter.machine import MAX_STEPS, Answer, Blocks, Machine
from irlx.interpreter.scope import Scope
from irlx.interpreter.setting import Setting
from irlx.interpreter.world import World
from irlx.language import tree
from irlx.language.data_lists import ImportedList
from irlx.language.modules import ImportedModule

__all__ = ["MAX_STEPS", "Answer", "Blocks", "Interpretation", "declared_scope", "interpret"]


_FRAMES = 4000
"""Frames of Python for the 150 levels of an expression, ten or so for each, inside those of statements."""


class Interpretation:
    """A program that is ready to run: everything declared, every body compiled.

    `lists` are the data lists that it imports, `modules` all modules that it needs, each behind those that
    it imports itself; `channels` what it reads and writes, by default memory. Raises InterpreterError for
    declarations that are wrong.
    """

    def __init__(
        self,
        program: tree.Program,
        source: SourceText,
        setting: Setting,
        lists: Sequence[ImportedList] = (),
        modules: Sequence[ImportedModule] = (),
        max_steps: int = MAX_STEPS,
        channels: Channels | None = None,
    ) -> None:
        self._machine = Machine(max_steps)
        self._world = World(setting, self._machine, channels)
        with _compiling():
            self._prepare(program, source, lists, modules)

    def _prepare(
        self,
        program: tree.Program,
        source: SourceText,
        lists: Sequence[ImportedList],
        modules: Sequence[ImportedModule],
    ) -> None:
        starts: list[Code] = []
        for module in modules:
            unit = Unit(self._world, module.source, module.tree, module.data_lists)
            self._world.modules[module.key] = unit.scope
            starts.append(unit.finish(module.tree, ()))
        main = Unit(self._world, source, program, lists)
        self.scope: Scope = main.scope
        code = main.finish(program, program.body)
        # The initial values of modules come first, each as a call: their places are in other texts.
        self._code = Code(source)
        for number, start in enumerate([*starts, code]):
            self._code.steps.append(self._start(start, program, number + 1))
            self._code.spans.append(program.name.span)

    def _start(self, code: Code, program: tree.Program, following: int) -> Step:
        machine, outer, span = self._machine, self._code, program.name.span
        return lambda frame: machine.enter(code, (), (outer, frame, following, -1, span))

    def run(self) -> Blocks:
        """Yield the blocks in order, and questions whose answers are sent back in; runs once.

        Raises InterpreterError at the statement that goes wrong; the blocks before it stay valid.
        """
        end: Callable[..., int] = lambda frame: self._machine.leave(self._code, None)  # noqa: E731
        self._code.steps.append(end)
        self._code.spans.append(self._code.spans[-1])
        return self._machine.run(self._code)

    @property
    def calls(self) -> tuple[Place, ...]:
        """Where the routines that are under way were called, the innermost first; some of them if many."""
        return self._machine.calls

    @property
    def warnings(self) -> list[Diagnostic]:
        """What the program did so far that deserves a look."""
        return self._machine.warnings

    def rewritten(self, found: ImportedList) -> Rewritten:
        """Text of an imported data list with the values that its variables have now."""
        return self._world.rewritten(found)


@contextmanager
def _compiling() -> Iterator[None]:
    """Room for expressions as deep as the parser takes them, and no search for garbage meanwhile.

    Compiling makes many objects, all of which stay: to look for others among them is half of the time.
    """
    collecting, depth = gc.isenabled(), sys.getrecursionlimit()
    gc.disable()
    sys.setrecursionlimit(max(depth, _FRAMES))
    try:
        yield
    finally:
        sys.setrecursionlimit(depth)
        if collecting:
            gc.enable()


def interpret(
    program: tree.Program,
    source: SourceText,
    setting: Setting,
    lists: Sequence[ImportedList] = (),
    modules: Sequence[ImportedModule] = (),
    max_steps: int = MAX_STEPS,
    channels: Channels | None = None,
) -> Blocks:
    """Run a program; see `Interpretation`. It may execute `max_steps` statements (IRL510)."""
    return Interpretation(program, source, setting, lists, modules, max_steps, channels).run()


def declared_scope(
    program: tree.Program, source: SourceText, setting: Setting, lists: Sequence[ImportedList] = ()
) -> Scope:
    """Scope of a program before its first statement: what it declares and imports, with first values."""
    return Interpretation(program, source, setting, lists).scope
