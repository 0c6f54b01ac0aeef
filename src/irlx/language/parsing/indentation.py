"""What the indentation of a text says of its blocks, asked only where their words do not fit each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from irlx.language.parsing.blocks import BOUNDARIES, BRANCH_WORDS, CLOSERS, PART_WORDS, STATEMENT_WORDS
from irlx.language.parsing.machine import END
from irlx.language.token import Token

__all__ = ["Hints", "read_indentation"]

_CLOSING = frozenset(CLOSERS.values())
_ENDS_STATEMENT = BOUNDARIES | {"COLON"}
_BEGINS = STATEMENT_WORDS | PART_WORDS | BRANCH_WORDS | _CLOSING
_LEAST_RATIO = 4
_WHOLE_FILE = frozenset({"PROGRAM", "MODULE", "DATALIST"})
_ROUTINES = frozenset({"PROCEDURE", "FUNCTION"})
# Words that stand as far left as the one that opened the block and belong to it.
_BELONGING = {
    "IF": frozenset({"ELSE", "ELSIF"}),
    "CASE": frozenset({"WHEN", "DEFAULT"}),
    "PROCEDURE": frozenset({"BEGIN", "VAR", "CONST", "TYPE"}),
    "FUNCTION": frozenset({"BEGIN", "VAR", "CONST", "TYPE"}),
}


@dataclass
class Hints:
    """Offsets of tokens: before which the END of a block seems to be missing, with the words that opened it;
    which END words seem to be too many; and which ELSE IF seem to mean ELSIF."""

    missing: dict[int, list[Token]] = field(default_factory=dict)
    extra: set[int] = field(default_factory=set)
    else_ifs: set[int] = field(default_factory=set)
    blocks: int = 0

    def __len__(self) -> int:
        return len(self.missing) + len(self.extra) + len(self.else_ifs)

    @property
    def trustworthy(self) -> bool:
        """Whether the text is indented by its blocks: most of them end where they seem to."""
        return len(self) * _LEAST_RATIO <= self.blocks


@dataclass
class _Open:
    token: Token
    column: int
    else_index: int | None = None
    begun: bool = False


def read_indentation(tokens: Sequence[Token]) -> Hints:
    """Compare the blocks of a text with its indentation; the last token stands for the end of the file."""
    reader = _Reader(tokens)
    for index in range(len(tokens)):
        reader.visit(index)
    return reader.hints


class _Reader:
    def __init__(self, tokens: Sequence[Token]) -> None:
        self._tokens = tokens
        self._stack: list[_Open] = []
        self._column = 0
        self.hints = Hints()

    def visit(self, index: int) -> None:
        token = self._tokens[index]
        before = self._tokens[index - 1] if index else None
        first = before is None or (token.line or 0) > (before.line or 0)
        if first:
            self._column = 0 if token.type == END else (token.column or 0)
        kind = self._kind(index, token)
        if first and (before is None or kind in _BEGINS or before.type in _ENDS_STATEMENT):
            self._dedent(index, kind)
        if kind in _CLOSING:
            self._close(index, kind, first=first)
        elif kind == "BEGIN" and self._stack:
            self._stack[-1].begun = True
        elif kind in CLOSERS and not (kind == "FOR" and before is not None and before.type == "WAIT"):
            if kind == "DATALIST" and index:
                return
            self.hints.blocks += 1
            same_line = before is not None and before.type == "ELSE" and not first
            self._stack.append(_Open(token, self._column, index - 1 if same_line and kind == "IF" else None))

    def _kind(self, index: int, token: Token) -> str:
        """What a token is in all likelihood: END, however it goes on, ends the block as deep as it stands."""
        if token.type != "NAME":
            return token.type
        if self._stack and token.casefold() == "end" and self._tokens[index - 1].type in _ENDS_STATEMENT:
            fitting = (one.token.type for one in reversed(self._stack) if one.column <= self._column)
            return CLOSERS[next(fitting, self._stack[-1].token.type)]
        return "NAME"

    def _dedent(self, index: int, kind: str) -> None:
        """A line begins: blocks that lie deeper, or as deep without owning the line, should have ended."""
        while self._stack:
            top = self._stack[-1]
            if top.token.type in _WHOLE_FILE or self._column > top.column:
                return
            if self._column == top.column and self._belongs(kind, top):
                return
            # The chain of ELSE IF is looked at as a whole when its ENDIF comes.
            if top.else_index is not None and kind in ("ENDIF", "ELSE", "ELSIF"):
                return
            self._stack.pop()
            self.hints.missing.setdefault(self._offset(index), []).append(top.token)

    def _offset(self, index: int) -> int:
        return self._tokens[index].start_pos or 0

    def _belongs(self, kind: str, top: _Open) -> bool:
        opener = top.token.type
        if kind == CLOSERS[opener]:
            return True
        if opener in _ROUTINES and top.begun:
            return False
        return kind in _BELONGING.get(opener, ())

    def _close(self, index: int, kind: str, *, first: bool) -> None:
        if not self._stack:
            self.hints.extra.add(self._offset(index))
            return
        top = self._stack[-1]
        if CLOSERS[top.token.type] != kind:
            self.hints.extra.add(self._offset(index))
        elif top.else_index is not None and first:
            self._close_chain(index)
        elif first and self._column > top.column and top.token.type not in _WHOLE_FILE:
            self.hints.extra.add(self._offset(index))
        else:
            self._stack.pop()

    def _close_chain(self, index: int) -> None:
        """ENDIF after IF .. ELSE IF .. ELSE IF: one for each, or one for all where ELSIF is meant."""
        chain = 0
        while self._stack[-1 - chain].else_index is not None and chain + 1 < len(self._stack):
            chain += 1
        if self._ends_from(index) > chain:
            self._stack.pop()
            return
        for one in self._stack[-chain:]:
            if one.else_index is not None:
                self.hints.else_ifs.add(self._offset(one.else_index))
        del self._stack[-chain - 1 :]

    def _ends_from(self, index: int) -> int:
        """How many ENDIF stand here one behind the other, none further left than the first."""
        count, column = 0, self._column
        while index < len(self._tokens):
            token = self._tokens[index]
            if token.type == "ENDIF":
                count += 1
                if (token.column or 0) < column:
                    return count - 1
            elif token.type != "SEMICOLON":
                break
            index += 1
        return count
