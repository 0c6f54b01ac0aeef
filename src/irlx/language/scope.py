"""Scopes: declared names by key, of the program and of a routine inside it."""

from __future__ import annotations

from collections.abc import Iterable

from irlx.diagnostics import Diagnostic, Place, Related, SourceText, report
from irlx.language.builtins import FUNCTIONS, PROCEDURES, SYSTEM_VARIABLES, TYPES
from irlx.language.symbols import Symbol

__all__ = ["Scope"]


class Scope:
    """Names of a program or routine; types have a space of their own, `POSE: pose` is no clash.

    `open` scopes hold names that the text does not show, those of a data list that is not known; `given`
    are names that the cell adds, hidden by what the text declares.
    """

    def __init__(
        self,
        source: SourceText,
        outer: Scope | None = None,
        given: Iterable[str] = (),
        *,
        open: bool = False,
    ) -> None:
        self.source = source
        self.outer = outer
        self.open: bool = open or (outer is not None and outer.open)
        self.given: dict[str, str] = {name.casefold(): name for name in given}
        self.values: dict[str, Symbol] = {}
        self.types: dict[str, Symbol] = {}

    def declare(self, symbols: Iterable[Symbol]) -> list[Diagnostic]:
        """Add symbols; the findings are duplicates and local names that hide outer ones."""
        findings = []
        for symbol in symbols:
            if not symbol.name.key:
                continue
            space = self.types if symbol.kind == "type" else self.values
            first = space.get(symbol.name.key)
            if first is not None:
                findings.append(self._clash("IRL202", symbol, first, "declared here first"))
                continue
            space[symbol.name.key] = symbol
            hidden = self.outer.values.get(symbol.name.key) if self.outer else None
            if hidden is not None and space is self.values:
                findings.append(self._clash("IRL213", symbol, hidden, "the name it hides"))
        return findings

    def _clash(self, code: str, symbol: Symbol, other: Symbol, words: str) -> Diagnostic:
        related = Related(words, self.place(other))
        return report(code, self.place(symbol), related=(related,), name=symbol.name.name)

    def place(self, symbol: Symbol) -> Place:
        """Where a symbol is declared."""
        return Place.in_text(symbol.source or self.source, symbol.name.span)

    def value(self, key: str) -> Symbol | None:
        """The innermost symbol of that name that is no type."""
        return self.values.get(key) or (self.outer.value(key) if self.outer else None)

    def is_given(self, key: str) -> bool:
        """Whether a name means something of the cell."""
        if self.value(key) is not None:
            return False
        return key in self.given or (self.outer is not None and self.outer.is_given(key))

    def type(self, key: str) -> Symbol | None:
        """The innermost declared type of that name; an imported name may be one."""
        found = self.types.get(key)
        if found is None:
            imported = self.values.get(key)
            found = imported if imported is not None and imported.kind == "import" else None
        return found or (self.outer.type(key) if self.outer else None)

    def known_values(self) -> list[str]:
        """Spellings of everything that may stand where a value is read, to suggest from."""
        return [*self._spellings("procedure"), *self._given(), *SYSTEM_VARIABLES.values()]

    def known_types(self) -> list[str]:
        """Spellings of all types."""
        outer = self.outer.known_types() if self.outer else list(TYPES.values())
        return [*outer, *(symbol.name.name for symbol in self.types.values())]

    def known_functions(self) -> list[str]:
        """Spellings of all functions."""
        return [*FUNCTIONS.values(), *self._of_kind("function")]

    def known_procedures(self) -> list[str]:
        """Spellings of all procedures."""
        return [*PROCEDURES.values(), *self._of_kind("procedure")]

    def _spellings(self, without: str) -> list[str]:
        outer = self.outer._spellings(without) if self.outer else []
        return outer + [s.name.name for s in self.values.values() if s.kind != without]

    def _given(self) -> list[str]:
        return [*(self.outer._given() if self.outer else []), *self.given.values()]

    def _of_kind(self, kind: str) -> list[str]:
        outer = self.outer._of_kind(kind) if self.outer else []
        return outer + [s.name.name for s in self.values.values() if s.kind == kind]
