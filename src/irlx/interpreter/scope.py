"""Variables, constants and types of a running program."""

from __future__ import annotations

from dataclasses import dataclass, field

from irlx.interpreter.types import Type
from irlx.interpreter.values import Value


@dataclass
class Variable:
    """A declared name: its spelling, type and present value."""

    name: str
    type: Type
    value: Value
    constant: bool = False


@dataclass
class Scope:
    """Names of one program by casefolded spelling; `announced` are those it declares anywhere, `imported`
    those of its data lists."""

    variables: dict[str, Variable] = field(default_factory=dict)
    types: dict[str, Type] = field(default_factory=dict)
    announced: frozenset[str] = frozenset()
    imported: frozenset[str] = frozenset()
