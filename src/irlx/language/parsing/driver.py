"""One parse: position in the tokens, open blocks, and the point to go back to after a mistake."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

from irlx.diagnostics import Diagnostic, Place, Related, SourceText, Span, report
from irlx.language.lexing import token_span
from irlx.language.parsing.blocks import BOUNDARIES, CLOSERS
from irlx.language.parsing.machine import END, Machine, Snapshot
from irlx.language.token import Token

__all__ = ["TRACKED", "Driver", "ParseStopped"]

MAX_ERRORS = 20
MAX_BLOCKS = 64
MAX_PARENS = 100

_CLOSING = frozenset(CLOSERS.values())
TRACKED = BOUNDARIES | _CLOSING | CLOSERS.keys()
TRACKED |= {"COLON", "LEFT_PAREN", "LEFT_BRACKET", "RIGHT_PAREN", "RIGHT_BRACKET"}
"""Kinds of tokens that change what the driver knows; others do so only where a statement begins."""


class ParseStopped(Exception):
    """Going on would only report what follows from mistakes already reported."""


class Driver:
    """Feeds tokens to the machine; the strategies of recovery act on it."""

    def __init__(self, source: SourceText, tokens: Sequence[Token]) -> None:
        length = len(source.text)
        self.source = source
        # Misspelt keywords are put right in this list.
        self.tokens = [*tokens, Token(END, "", start_pos=length, end_pos=length, line=0)]
        self.index = 0
        self.machine = Machine()
        self.blocks: list[Token] = []
        self.findings: list[Diagnostic] = []
        self.errors = 0
        self.complete = True
        self.at_boundary = True
        self.statement_index = 0
        self.head = ""
        self.depth = 0
        self.keywords_as_names: set[str] = set()
        self._checkpoint: Snapshot = self.machine.snapshot()
        self._checkpoint_blocks: tuple[Token, ...] = ()

    @property
    def token(self) -> Token:
        """The token that comes next."""
        return self.tokens[self.index]

    @property
    def following(self) -> Token:
        """The token after the next one."""
        return self.tokens[min(self.index + 1, len(self.tokens) - 1)]

    @property
    def previous(self) -> Token | None:
        """The token before the next one, or None at the start."""
        return self.tokens[self.index - 1] if self.index else None

    @property
    def previous_end(self) -> int:
        """Offset where the token before ends."""
        return self.previous.end_pos if self.previous is not None else 0

    @property
    def on_new_line(self) -> bool:
        """Whether the next token stands on a later line than the one before."""
        return self.previous is None or self.token.type == END or _line(self.token) > _line(self.previous)

    @property
    def statement_tokens(self) -> Sequence[Token]:
        """Tokens since the last boundary between statements."""
        return self.tokens[self.statement_index : self.index]

    @cached_property
    def declared_words(self) -> frozenset[str]:
        """Casefolded names of everything that may be called: routines of the text, and what it imports."""
        found, importing = set(), False
        for before, token in zip(self.tokens, self.tokens[1:], strict=False):
            importing = before.type == "IMPORT" or (importing and token.type != "SEMICOLON")
            if importing or before.type in ("PROCEDURE", "FUNCTION"):
                found.add(token.casefold())
        return frozenset(found)

    def accepts_at_start(self, *kinds: str) -> bool:
        """Whether terminals of these kinds would fit where the present statement begins."""
        return self.machine.accepts_from(self._checkpoint, *kinds)

    def replace_start(self, kind: str) -> None:
        """Put a keyword in place of the first token of the present statement, and go back to it."""
        self.roll_back()
        self.index = self.statement_index
        self.replace(kind)

    def replace(self, kind: str) -> None:
        """Put a keyword in place of the next token."""
        old = self.token
        self.tokens[self.index] = Token(kind, old, old.start_pos, old.end_pos, old.line, old.column)

    def shifted(self, token: Token) -> None:
        """Keep track of a token that the machine has taken."""
        if self.at_boundary:
            self._checkpoint = self.machine.snapshot(without_last=1)
            self._checkpoint_blocks = tuple(self.blocks)
            self.statement_index = self.index
            # As a name, DATALIST begins a statement like any other name.
            self.head = "NAME" if token.type == "DATALIST" and not self._opens_list(token) else token.type
            self.at_boundary = False
        if token.type in TRACKED:
            self._track(token)

    def _track(self, token: Token) -> None:
        kind = token.type
        if kind in BOUNDARIES:
            self.at_boundary = self.depth == 0
        elif kind == "COLON":
            self.at_boundary = self.head in ("WHEN", "DEFAULT") and self.depth == 0
        elif kind in ("LEFT_PAREN", "LEFT_BRACKET"):
            self.depth += 1
            if self.depth > MAX_PARENS:
                self.report("IRL118", token_span(token), limit=MAX_PARENS, what="parentheses")
                raise ParseStopped
        elif kind in ("RIGHT_PAREN", "RIGHT_BRACKET"):
            self.depth -= 1
        elif kind in _CLOSING and self.blocks:
            self.blocks.pop()
        if kind in CLOSERS and self._opens(token):
            self.blocks.append(token)
            if len(self.blocks) > MAX_BLOCKS:
                self.report("IRL118", token_span(token), limit=MAX_BLOCKS, what="statements")
                raise ParseStopped

    def _opens(self, token: Token) -> bool:
        """Whether a word with a closer opens a block where it stands."""
        if token.type == "DATALIST":
            return self._opens_list(token)
        return not (token.type == "FOR" and self.head == "WAIT")

    def _opens_list(self, token: Token) -> bool:
        """Whether DATALIST begins the file; elsewhere it is a name, or stands in an IMPORT."""
        return not self.blocks and self.tokens[0].type == "DATALIST"

    def take(self, token: Token) -> None:
        """Feed a token in place of the next one; ParseStopped where it does not fit."""
        if not self.machine.feed(token):
            raise ParseStopped
        self.shifted(token)

    def insert(self, *kinds: str) -> None:
        """Feed tokens that the text lacks, placed at the end of the token before."""
        # Where the parse stops at a block that is too deep, its first word is taken but still the next token.
        end = max(self.previous_end, self.blocks[-1].end_pos if self.blocks else 0)
        line = _line(self.previous) if self.previous is not None else 1
        for kind in kinds:
            text = kind if kind == "NAME" else kind.lower()
            token = Token(kind, "" if kind == "NAME" else text, start_pos=end, end_pos=end, line=line)
            self.take(token)

    def roll_back(self) -> None:
        """Forget the statement that has begun, if one has."""
        if not self.at_boundary:
            self.machine.restore(self._checkpoint)
            self.blocks = list(self._checkpoint_blocks)
            self.at_boundary = True
        self.depth = 0

    def report(self, code: str, span: Span, *, related: tuple[Related, ...] = (), **data: Any) -> None:
        """Add a finding; stops the parse at the limit of errors."""
        finding = report(code, self.place(span), related=related, **data)
        self.findings.append(finding)
        self.errors += finding.is_error
        if self.errors >= MAX_ERRORS:
            raise ParseStopped

    def place(self, span: Span) -> Place:
        """Place of a span in the text."""
        return Place.in_text(self.source, span)


def _line(token: Token) -> int:
    return token.line or 0
