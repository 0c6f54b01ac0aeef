"""Variables and their parts: reading them, setting them, and giving them by reference."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

from irlx.diagnostics.diagnostic import near_matches
from irlx.interpreter.code import Frame
from irlx.interpreter.compiled import Compiled, Run
from irlx.interpreter.errors import InterpreterError, fail
from irlx.interpreter.scope import Followed, Local, PartCell, Routine, Signal, SlotCell, Variable
from irlx.interpreter.system_names import system_name
from irlx.interpreter.types import CHAR, INT, STRING, Array, Record, Simple, Type
from irlx.interpreter.values import UNSET, ArrayValue, has_arrays, is_set, replaced, share, unset_part
from irlx.language import tree
from irlx.language.builtins import FOLLOWED
from irlx.language.words import count

if TYPE_CHECKING:
    from irlx.interpreter.expressions import Expressions

"""What R_TOOL and R_WEIGHTS are for messages."""
_NOT_CONSTANT = "a bound or constant that is not the same in every call"


@dataclass(frozen=True)
class Way:
    """The way from a variable to a part of it: steps that are known, or functions that give them.

    `type` is that of the part; `letter` gives the number of a character where that is the last step.
    """

    steps: tuple[int | Run, ...]
    type: Type
    letter: Run | None = None
    letter_node: tree.Node | None = None

    def of(self, frame: Frame) -> list[int]:
        """The steps in a frame."""
        return [step if isinstance(step, int) else step(frame) for step in self.steps]


class Designators:
    """Compiles designators in the scope of expressions."""

    def __init__(self, expressions: Expressions) -> None:
        self._expressions = expressions

    def stored(self, name: tree.Name) -> Variable | Local:
        """The variable of a name. Raises InterpreterError: IRL201, with near matches; IRL291 for a frame
        that moves; IRL590 for what the language has and this version does not execute."""
        context = self._expressions.context
        scope, source = context.scope, context.source
        found = scope.found(name.key)
        if isinstance(found, Routine):
            what = f"the {'procedure' if found.result is None else 'function'} {found.name}"
            raise fail("IRL222", source, name.span, expected="a variable", found=what)
        if found is not None:
            changing = isinstance(found, Local) or (scope.outer is not None and not found.constant)
            if changing and context.assembler is None:
                raise fail("IRL590", source, name.span, what=_NOT_CONSTANT)
            return found
        port = self.signal(name)
        if port is not None:
            return port
        if name.key in context.setting.frames:
            raise fail("IRL291", source, name.span, name=name.name)
        what = system_name(name)
        if what:
            raise fail("IRL590", source, name.span, what=what)
        near = "; it is declared further down" if scope.is_announced(name.key) else ""
        if scope.is_imported(name.key):
            near = "; it comes from a data list and is a variable, of which constants know nothing"
        near = near or near_matches(name.name, scope.spellings())
        raise fail("IRL201", source, name.span, name=name.name, near=near)

    def signal(self, name: tree.Name) -> Signal | None:
        """The signal of a name: a declared one, or a port that no declaration hides; else None."""
        found = self._expressions.scope.found(name.key)
        if found is not None:
            return found if isinstance(found, Signal) else None
        from irlx.interpreter.signals import port_signal

        port = port_signal(name)
        return None if port is None else self._expressions.scope.add_port(name.key, port)

    # ---- reading

    def read(self, node: tree.Designator) -> Compiled:
        """The value of a designator; IRL501 when run where there is none. Raises InterpreterError."""
        stored = self.stored(node.base)
        way = self.way(node, stored.type)
        return self.part(node, _whole(stored), way)

    def part(self, node: tree.Designator, whole: Run, way: Way) -> Compiled:
        """The part of a value that a way leads to."""
        if way.letter is not None:
            text = self._checked(node, _descended(whole, way), STRING)
            return Compiled(CHAR, self._letter(node, text, way.letter, way.letter_node or node))
        return Compiled(way.type, self._checked(node, _descended(whole, way), way.type))

    def _checked(self, node: tree.Designator, run: Run, type: Type) -> Run:
        """The value, which must be there; arrays of it are shared from now on."""
        if isinstance(type, Simple):

            def simple(frame: Frame) -> Any:
                value = run(frame)
                if value is UNSET:
                    raise self._unset(node, value)
                return value

            return simple
        holds_arrays = has_arrays(type)

        def structured(frame: Frame) -> Any:
            value = run(frame)
            if not is_set(value):
                raise self._unset(node, value)
            if holds_arrays:
                share(value)
            return value

        return structured

    def _unset(self, node: tree.Designator, value: Any) -> InterpreterError:
        source = self._expressions.source
        name = source.text[node.span.start : node.span.end]
        return fail("IRL501", source, node.span, name=name + unset_part(value))

    def _letter(self, node: tree.Designator, text: Run, number: Run, place: tree.Node) -> Run:
        source = self._expressions.source

        def letter(frame: Frame) -> str:
            value, at = text(frame), number(frame)
            if not 1 <= at <= len(value):
                data = {"index": at, "name": node.base.name, "low": 1, "high": len(value)}
                raise fail("IRL504", source, place.span, **data)
            return str(value[at - 1])

        return letter

    # ---- setting

    def setter(
        self, node: tree.Designator, *, keep: bool = False, followed: bool = False
    ) -> tuple[Type, Callable[[Frame, Any], None], Callable[[Frame], object] | None]:
        """Type of a designator that may be set, what sets it in a frame, and what finds its place there.

        The last is None where nothing can be wrong with the place. Raises InterpreterError: IRL211.

        What the robot follows is set by assignments alone, which pass `followed`; for others it is IRL249.

        With `keep` the place is found here and not when it is set: steps that follow may change an index.
        """
        stored, way = self._settable(node)
        if isinstance(stored, Followed) and not followed:
            data = {"where": "this statement", "found": FOLLOWED}
            raise fail("IRL249", self._expressions.source, node.span, **data)
        if keep:
            kept = self._expressions.kept
            steps = (s if isinstance(s, int) else kept(node, Compiled(INT, s)).run for s in way.steps)
            way = replace(way, steps=tuple(steps))
        known = all(isinstance(step, int) for step in way.steps)
        return way.type, _setter(stored, way), None if known else way.of

    def _settable(self, node: tree.Designator) -> tuple[Variable | Local, Way]:
        source, stored = self._expressions.source, self.stored(node.base)
        if stored.constant:
            raise fail("IRL211", source, node.span, name=stored.name, kind="a constant")
        if isinstance(stored, Signal) and stored.is_input:
            raise fail("IRL211", source, node.span, name=stored.name, kind="an input")
        way = self.way(node, stored.type)
        if way.letter is not None:
            data = {"expected": "a variable", "found": "a character of a text"}
            raise fail("IRL222", source, node.span, **data)
        return stored, way

    def cell(self, node: tree.Expression, where: str) -> Compiled:
        """What a parameter by reference gets: running it gives a cell of the variable or its part.

        `where` tells in words what needs the variable.

        Raises InterpreterError: IRL249 for what is no variable, IRL211 for a constant.
        """
        if not isinstance(node, tree.Designator) or self.signal(node.base) is not None:
            raise fail("IRL249", self._expressions.source, node.span, where=where, found=_what(node))
        stored, way = self._settable(node)
        if isinstance(stored, Followed):
            raise fail("IRL249", self._expressions.source, node.span, where=where, found=FOLLOWED)
        whole = _cell(stored)
        if not way.steps:
            return Compiled(way.type, whole)
        return Compiled(way.type, lambda frame: PartCell(whole(frame), way.of(frame)))

    # ---- the way to a part

    def way(self, node: tree.Designator, type: Type) -> Way:
        """How to get from a variable of a type to the part that a designator names. Raises InterpreterError.

        A dotted field is taken as long as it is declared: of `a1` and `a1.max`, `v.a1.max` is the latter.
        """
        steps: list[int | Run] = []
        selectors = list(node.selectors)
        while selectors:
            selector = selectors[0]
            if isinstance(selector, tree.Index) and type == STRING and len(selectors) == 1:
                (run,) = self._indices(selector, 1, "STRING")
                return Way(tuple(steps), CHAR, run, selector.indices[0])
            if isinstance(selector, tree.Index):
                step, type = self._element(type, selector, node)
                steps.append(step)
                selectors = selectors[1:]
            else:
                position, type, used = self._field(type, selectors)
                steps.append(position)
                selectors = selectors[used:]
        return Way(tuple(steps), type)

    def _field(self, type: Type, selectors: Sequence[tree.Selector]) -> tuple[int, Type, int]:
        fields: list[tree.Field] = []
        for selector in selectors:
            if not isinstance(selector, tree.Field):
                break
            fields.append(selector)
        index = type.index if isinstance(type, Record) else {}
        for used in range(len(fields), 0, -1):
            position = index.get(".".join(field.key for field in fields[:used]))
            if position is not None and isinstance(type, Record):
                return position, type.fields[position][1], used
        known = [name for name, _ in type.fields] if isinstance(type, Record) else []
        name = ".".join(field.name for field in fields)
        data = {"type": type.name, "name": name, "near": near_matches(name, known)}
        raise fail("IRL225", self._expressions.source, selectors[0].span, **data)

    def _indices(self, selector: tree.Index, needed: int, type: str) -> list[Run]:
        if len(selector.indices) != needed:
            expected = count(needed, "index", "indices")
            data = {"type": type, "expected": expected, "found": len(selector.indices)}
            raise fail("IRL223", self._expressions.source, selector.span, **data)
        value = self._expressions.value
        wanted = [(index, partial(value, index, INT)) for index in selector.indices]
        return [part.run for part in self._expressions.operands(wanted)]

    def _element(self, type: Type, selector: tree.Index, node: tree.Designator) -> tuple[int | Run, Type]:
        source = self._expressions.source
        if not isinstance(type, Array):
            raise fail("IRL222", source, selector.span, expected="an ARRAY before [", found=type.name)
        runs = self._indices(selector, len(type.ranges), type.name)
        bounds = list(zip(runs, type.ranges, selector.indices, strict=True))

        def outside(index: int, low: int, high: int, at: tree.Node) -> InterpreterError:
            data = {"index": index, "name": node.base.name, "low": low, "high": high}
            return fail("IRL504", source, at.span, **data)

        if len(bounds) == 1:
            run, (low, high), at = bounds[0]

            def line(frame: Frame) -> int:
                index: int = run(frame)
                if low <= index <= high:
                    return index - low
                raise outside(index, low, high, at)

            return line, type.element

        def position(frame: Frame) -> int:
            found = 0
            for run, (low, high), at in bounds:
                index: int = run(frame)
                if not low <= index <= high:
                    raise outside(index, low, high, at)
                found = found * (high - low + 1) + index - low
            return found

        return position, type.element


# ---- variables in frames


def _what(node: tree.Expression) -> str:
    """What an expression is that is no variable."""
    match node:
        case tree.Designator():
            return "a signal"
        case tree.IntLiteral() | tree.RealLiteral():
            return "a number"
        case tree.StringLiteral():
            return "a text"
    return "an expression"


def _whole(stored: Variable | Local) -> Run:
    """Gives the raw value of a variable in a frame."""
    if isinstance(stored, Variable):
        return lambda _: stored.value
    slot = stored.slot
    if stored.by_reference:
        return lambda frame: frame[slot].value
    return lambda frame: frame[slot]


def _cell(stored: Variable | Local) -> Run:
    """Gives a cell of a variable in a frame."""
    if isinstance(stored, Variable):
        return lambda _: stored
    slot = stored.slot
    if stored.by_reference:
        return lambda frame: frame[slot]
    return lambda frame: SlotCell(frame, slot)


def _descended(whole: Run, way: Way) -> Run:
    """Gives the part of a value, without a look at whether it is set."""
    if not way.steps:
        return whole
    if len(way.steps) == 1:
        step = way.steps[0]
        if isinstance(step, int):
            return lambda frame: whole(frame).values[step]
        return lambda frame: whole(frame).values[step(frame)]

    def part(frame: Frame) -> Any:
        value = whole(frame)
        for step in way.steps:
            value = value.values[step if isinstance(step, int) else step(frame)]
        return value

    return part


def _setter(stored: Variable | Local, way: Way) -> Callable[[Frame, Any], None]:
    """Sets a variable or a part of it in a frame."""
    if not way.steps and isinstance(stored, Variable):

        def set_variable(_: Frame, value: Any) -> None:
            stored.value = value

        return set_variable
    if not way.steps and not stored.by_reference:  # type: ignore[union-attr]
        slot = stored.slot  # type: ignore[union-attr]

        def set_slot(frame: Frame, value: Any) -> None:
            frame[slot] = value

        return set_slot
    cell = _cell(stored)

    def set_part(frame: Frame, value: Any) -> None:
        whole = cell(frame)
        if not way.steps:
            whole.value = value
            return
        held, steps = whole.value, way.of(frame)
        if len(steps) == 1 and isinstance(held, ArrayValue) and not held.shared:
            held.values[steps[0]] = value
        else:
            whole.value = replaced(held, steps, value)

    return set_part
