"""The LALR machine: Lark's tables, driven token by token so that recovery can step in anywhere."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, TypeAlias

from lark import Token
from lark.parsers.lalr_analysis import Shift

from irlx.language.grammar import load_grammar

__all__ = ["END", "Machine", "Snapshot"]

END = "$END"

_Reduction: TypeAlias = tuple["Callable[[list[Any]], Any] | None", int, str]
_Row: TypeAlias = "dict[str, int | _Reduction]"


class _Tables:
    """Lark's tables in the form the machine reads fastest; a state is converted on first use.

    A reduction without a callback leaves the value as it is: the unit rules of expressions.
    """

    def __init__(self) -> None:
        state = load_grammar().parse_interactive().parser_state
        self._conf = state.parse_conf
        self.start: int = self._conf.start_state
        self.end: int = self._conf.end_state
        self._rows: dict[int, _Row] = {}

    def row(self, state: int) -> _Row:
        """Actions of a state by terminal, and its successors by rule."""
        row = self._rows.get(state)
        if row is None:
            actions = self._conf.states[state]
            row = {
                symbol: argument if action is Shift else self._reduction(argument)
                for symbol, (action, argument) in actions.items()
            }
            self._rows[state] = row
        return row

    def _reduction(self, rule: Any) -> _Reduction:
        size = len(rule.expansion)
        name = rule.origin.name
        unchanged = size == 1 and rule.options.expand1 and not rule.alias
        if unchanged and not rule.expansion[0].name.startswith("_"):
            return None, size, name
        return self._conf.callbacks[rule], size, name


@lru_cache(maxsize=1)
def _tables() -> _Tables:
    return _Tables()


@dataclass(frozen=True)
class Snapshot:
    """Stacks of a machine at a boundary between statements."""

    states: tuple[int, ...]
    values: tuple[Any, ...]


class Machine:
    """Stacks of one parse."""

    def __init__(self) -> None:
        self._tables = _tables()
        self._states = [self._tables.start]
        self._values: list[Any] = []
        self.result: Any = None

    def feed(self, token: Token) -> bool:
        """Take one token; False, with only reductions done, when it does not fit."""
        states, values, row_of = self._states, self._values, self._tables.row
        kind = token.type
        row = row_of(states[-1])
        while True:
            action = row.get(kind)
            if action is None:
                return False
            if type(action) is int:
                states.append(action)
                values.append(token)
                return True
            build, size, name = action  # type: ignore[misc]
            if build is None:
                states.pop()
            elif size:
                children = values[-size:]
                del states[-size:]
                del values[-size:]
                values.append(build(children))
            else:
                values.append(build([]))
            state = row_of(states[-1])[name]
            states.append(state)  # type: ignore[arg-type]
            if state == self._tables.end and kind == END:
                self.result = values[-1]
                return True
            row = row_of(state)  # type: ignore[arg-type]

    def accepts(self, *kinds: str) -> bool:
        """Whether terminals of these kinds would fit, one after the other; changes nothing."""
        states = list(self._states)
        return all(self._advance(states, kind) for kind in kinds)

    def _advance(self, states: list[int], kind: str) -> bool:
        while True:
            action = self._tables.row(states[-1]).get(kind)
            if action is None:
                return False
            if isinstance(action, int):
                states.append(action)
                return True
            _, size, name = action
            if size:
                del states[-size:]
            successor = self._tables.row(states[-1])[name]
            assert isinstance(successor, int)
            states.append(successor)
            if kind == END and successor == self._tables.end:
                return True

    def expected(self) -> frozenset[str]:
        """Kinds of all terminals that would fit next."""
        kinds = self._tables.row(self._states[-1])
        return frozenset(kind for kind in kinds if kind.isupper() and self.accepts(kind))

    def snapshot(self, without_last: int = 0) -> Snapshot:
        """The stacks, leaving out the tokens taken last."""
        end = -without_last or None
        return Snapshot(tuple(self._states[:end]), tuple(self._values[:end]))

    def restore(self, snapshot: Snapshot) -> None:
        """Go back to a snapshot."""
        self._states = list(snapshot.states)
        self._values = list(snapshot.values)
