"""What the names of a program stand for while it runs: variables, routines and types."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

from irlx.blocks import Port
from irlx.interpreter.code import Code, Frame
from irlx.interpreter.types import Type
from irlx.interpreter.values import Value, replaced


@dataclass(slots=True)
class Variable:
    """A declared name that exists once: its spelling, type and present value."""

    name: str
    type: Type
    value: Value
    constant: bool = False


@dataclass(slots=True)
class Followed(Variable):
    """A system variable that the robot follows: what changes it becomes a block."""


@dataclass(slots=True, kw_only=True)
class Signal(Variable):
    """A name of an input or output; the value of an output is what was set last."""

    port: Port
    is_input: bool


@dataclass(frozen=True)
class Local:
    """A name of a routine, in a slot of the frame of each call: the value, or with `by_reference` a cell."""

    name: str
    type: Type
    slot: int
    by_reference: bool = False
    constant: bool = False


class SlotCell:
    """A local variable that a call was given by reference."""

    __slots__ = ("_frame", "_slot")

    def __init__(self, frame: Frame, slot: int) -> None:
        self._frame, self._slot = frame, slot

    @property
    def value(self) -> Value:
        """The present value."""
        found: Value = self._frame[self._slot]
        return found

    @value.setter
    def value(self, value: Value) -> None:
        self._frame[self._slot] = value


class PartCell:
    """Part of a variable that a call was given by reference."""

    __slots__ = ("_steps", "_whole")

    def __init__(self, whole: Cell, steps: Sequence[int]) -> None:
        self._whole, self._steps = whole, steps

    @property
    def value(self) -> Value:
        """The present value."""
        value = self._whole.value
        for step in self._steps:
            value = value.values[step]  # type: ignore[union-attr]
        return value

    @value.setter
    def value(self, value: Value) -> None:
        self._whole.value = replaced(self._whole.value, self._steps, value)


Cell: TypeAlias = "Variable | SlotCell | PartCell"


@dataclass(frozen=True)
class Parameter:
    """A parameter of a routine."""

    name: str
    type: Type
    by_reference: bool


@dataclass
class Routine:
    """A procedure, or with a `result` a function; its code is there before the first statement runs."""

    name: str
    parameters: tuple[Parameter, ...]
    result: Type | None
    code: Code


@dataclass
class Scope:
    """Names of a program, module or routine by casefolded spelling, inside those of `outer`.

    `announced` are those it declares anywhere, `imported` those of its data lists.
    """

    variables: dict[str, Variable | Local] = field(default_factory=dict)
    types: dict[str, Type] = field(default_factory=dict)
    routines: dict[str, Routine] = field(default_factory=dict)
    announced: frozenset[str] = frozenset()
    imported: frozenset[str] = frozenset()
    outer: Scope | None = None

    def _chain(self) -> Iterator[Scope]:
        scope: Scope | None = self
        while scope is not None:
            yield scope
            scope = scope.outer

    def found(self, key: str) -> Variable | Local | Routine | None:
        """The innermost variable, constant or routine of a name."""
        for scope in self._chain():
            found = scope.variables.get(key) or scope.routines.get(key)
            if found is not None:
                return found
        return None

    def signals(self) -> list[Signal]:
        """All signals."""
        stored = (variable for scope in self._chain() for variable in scope.variables.values())
        return [variable for variable in stored if isinstance(variable, Signal)]

    def add_port(self, key: str, signal: Signal) -> Signal:
        """Declare a port that is used by its own name, for everything around as well."""
        *_, outermost = self._chain()
        outermost.variables[key] = signal
        return signal

    def type(self, key: str) -> Type | None:
        """The innermost type of a name."""
        return next((scope.types[key] for scope in self._chain() if key in scope.types), None)

    def type_keys(self) -> list[str]:
        """Casefolded names of all types."""
        return [key for scope in self._chain() for key in scope.types]

    def spellings(self) -> list[str]:
        """Names of all variables and constants, to suggest from."""
        return [variable.name for scope in self._chain() for variable in scope.variables.values()]

    def is_announced(self, key: str) -> bool:
        """Whether a name is declared somewhere, further down perhaps."""
        return any(key in scope.announced for scope in self._chain())

    def is_imported(self, key: str) -> bool:
        """Whether a name comes from a data list."""
        return any(key in scope.imported for scope in self._chain())
