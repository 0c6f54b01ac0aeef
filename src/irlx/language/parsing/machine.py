"""The LALR machine: tables of the grammar, driven token by token so that recovery can step in anywhere."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from irlx.language.parsing.tables import Tables, read_tables
from irlx.language.token import Token

__all__ = ["END", "Machine", "Snapshot"]

END = "$END"


@lru_cache(maxsize=1)
def _tables() -> Tables:
    return read_tables()


@dataclass(frozen=True)
class Snapshot:
    """Stacks of a machine at a boundary between statements."""

    states: tuple[int, ...]
    values: tuple[Any, ...]


class Machine:
    """Stacks of one parse."""

    def __init__(self) -> None:
        self._tables = _tables()
        self._rows = self._tables.rows
        self._states = [self._tables.start]
        self._values: list[Any] = []
        self.result: Any = None

    def feed(self, token: Token) -> bool:
        """Take one token; False, with only reductions done, when it does not fit."""
        states, values, rows = self._states, self._values, self._rows
        kind = token.type
        row = rows[states[-1]]
        while True:
            action = row.get(kind)
            if action is None:
                if kind != END or states[-1] != self._tables.end:
                    return False
                self.result = values[-1]
                return True
            if type(action) is int:
                states.append(action)
                values.append(token)
                return True
            build, size, name = action  # type: ignore[misc]
            if build is None:
                row = rows[self._after_unit_rules(kind)]
                continue
            if size:
                children = values[-size:]
                del states[-size:]
                del values[-size:]
                values.append(build(children))
            else:
                values.append(build([]))
            state = rows[states[-1]][name]
            states.append(state)  # type: ignore[arg-type]
            row = rows[state]  # type: ignore[index]

    def _after_unit_rules(self, kind: str) -> int:
        """Reduce by the unit rules that a terminal asks for, which leave the value; gives the state then.

        From a name to an expression there are nine of them, so what they lead to is kept.
        """
        states, rows = self._states, self._rows
        key = (states[-2], states[-1], kind)
        state = self._tables.chains.get(key)
        if state is None:
            below, state, _ = key
            while True:
                action = rows[state].get(kind)
                if action is None or isinstance(action, int) or action[0] is not None:
                    break
                state = rows[below][action[2]]  # type: ignore[assignment]
            self._tables.chains[key] = state
        states[-1] = state
        return state

    def accepts(self, *kinds: str) -> bool:
        """Whether terminals of these kinds would fit, one after the other; changes nothing."""
        states = list(self._states)
        return all(self._advance(states, kind) for kind in kinds)

    def accepts_from(self, snapshot: Snapshot, *kinds: str) -> bool:
        """Whether terminals of these kinds would fit after going back to a snapshot; changes nothing."""
        states = list(snapshot.states)
        return all(self._advance(states, kind) for kind in kinds)

    def _advance(self, states: list[int], kind: str) -> bool:
        while True:
            action = self._rows[states[-1]].get(kind)
            if action is None:
                return False
            if isinstance(action, int):
                states.append(action)
                return True
            _, size, name = action
            if size:
                del states[-size:]
            successor = self._rows[states[-1]][name]
            assert isinstance(successor, int)
            states.append(successor)
            if kind == END and successor == self._tables.end:
                return True

    def expected(self) -> frozenset[str]:
        """Kinds of all terminals that would fit next."""
        kinds = self._rows[self._states[-1]]
        return frozenset(kind for kind in kinds if kind.isupper() and self.accepts(kind))

    @property
    def last(self) -> Any:
        """What lies on top of the stack: the token taken last, or the node it was reduced to."""
        return self._values[-1] if self._values else None

    def snapshot(self, without_last: int = 0) -> Snapshot:
        """The stacks, leaving out the tokens taken last."""
        end = -without_last or None
        return Snapshot(tuple(self._states[:end]), tuple(self._values[:end]))

    def restore(self, snapshot: Snapshot) -> None:
        """Go back to a snapshot."""
        self._states = list(snapshot.states)
        self._values = list(snapshot.values)
