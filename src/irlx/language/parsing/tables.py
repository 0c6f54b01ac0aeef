"""The LALR tables of the grammar, compiled beforehand by `grammar/make_tables.py`."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

from irlx.language.builder import TreeBuilder
from irlx.language.grammar_text import grammar_file

__all__ = ["Tables", "read_tables"]

_Build: TypeAlias = Callable[[list[Any]], Any]
_Reduction: TypeAlias = tuple[_Build | None, int, str]
_Row: TypeAlias = dict[str, int | _Reduction]


class _Rows(dict[int, _Row]):
    """Rows by state, made when they are first asked for."""

    def __init__(self, make: Callable[[int], _Row]) -> None:
        super().__init__()
        self._make = make

    def __missing__(self, state: int) -> _Row:
        row = self[state] = self._make(state)
        return row


class Tables:
    """Actions by state and symbol: the state after a terminal or a rule, or the reduction that is due.

    A reduction is what builds a node of the children, how many there are, and the symbol of its rule; one
    that builds nothing leaves the value as it is: the unit rules of expressions. `chains` is for the machine
    to keep where such rules lead.
    """

    def __init__(
        self, symbols: Sequence[str], rules: Sequence[Any], rows: Sequence[list[int]], end: int
    ) -> None:
        builder = TreeBuilder()
        self._symbols, self._rows = symbols, rows
        self._reductions = [
            (_build(builder, name, method, spliced), size, name) for name, size, method, spliced in rules
        ]
        self.start, self.end = 0, end
        self.rows = _Rows(self._row)
        self.chains: dict[tuple[int, int, str], int] = {}

    def _row(self, state: int) -> _Row:
        pairs = iter(self._rows[state])
        return {
            self._symbols[symbol]: action if action >= 0 else self._reductions[-1 - action]
            for symbol, action in zip(pairs, pairs, strict=True)
        }


def read_tables() -> Tables:
    """The tables of the grammar; FileNotFoundError where the installation is damaged."""
    return Tables(**json.loads(grammar_file("irl.tables.json").read_bytes()))


def _build(builder: TreeBuilder, name: str, method: str | None, spliced: list[int]) -> _Build | None:
    """What a rule makes of its children, some of which are lists to be spliced in."""
    if method is not None:
        make = getattr(builder, method)
        return _splicing(make, spliced) if spliced else make
    if not name.startswith("_"):
        return None
    return _splicing(_as_it_is, spliced) if spliced else _as_it_is


def _as_it_is(children: list[Any]) -> list[Any]:
    return children


def _splicing(make: _Build, spliced: list[int]) -> _Build:
    if spliced == [0]:

        def grow(children: list[Any]) -> Any:
            # The list that has been growing is no one else's: long ones would cost their length each time.
            gathered = children[0]
            gathered += children[1:]
            return make(gathered)

        return grow

    def splice(children: list[Any]) -> Any:
        gathered: list[Any] = []
        for place, child in enumerate(children):
            if place not in spliced:
                gathered.append(child)
            elif gathered:
                gathered += child
            else:
                gathered = child
        return make(gathered)

    return splice
