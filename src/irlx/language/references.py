"""Uses of names: where each stands, what it means there, and what is done with it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, NamedTuple, TypeAlias

from irlx.diagnostics import Span
from irlx.language.symbols import Symbol

__all__ = ["Access", "Reference", "RoutineScope"]

Access: TypeAlias = Literal["read", "set", "change", "call", "type"]


class Reference(NamedTuple):
    """One use of a declared name; a VAR argument may `change` its variable."""

    span: Span
    symbol: Symbol
    access: Access


@dataclass(frozen=True)
class RoutineScope:
    """Names that a procedure or function declares inside of `span`, by casefolded name."""

    span: Span
    symbols: Mapping[str, Symbol] = field(default_factory=dict)
    types: Mapping[str, Symbol] = field(default_factory=dict)
