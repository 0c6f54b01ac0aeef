"""The tokens of a text one after the other, each with the comments that belong to it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

from irlx.diagnostics import SourceText, Span
from irlx.language.format.document import Doc, Remark
from irlx.language.parsing.blocks import BOUNDARIES
from irlx.language.token import Token

__all__ = ["Tokens", "UnexpectedToken"]

_OPENERS = frozenset({"SEMICOLON", "BEGIN", "THEN", "ELSE", "DO", "REPEAT", "COLON"})
"""A ``;`` right behind one of these ends no statement."""
_END = Token("$END", "")


class UnexpectedToken(Exception):
    """The tokens are not those that the tree tells of: a fault of the formatter."""


@dataclass
class _Gap:
    """Comments before a token, and how many lines each begins after what stands before it."""

    remarks: list[Remark] = field(default_factory=list)
    line_ends: list[int] = field(default_factory=list)
    last: int = 0


class Tokens:
    """A cursor over the tokens; what is taken is a document that holds the comments as well."""

    def __init__(self, source: SourceText, tokens: Sequence[Token], comments: Sequence[Span]) -> None:
        self._source = source
        self._tokens: list[Token] = []
        for token in tokens:
            before = self._tokens[-1].type if self._tokens else ""
            if token.type != "SEMICOLON" or before not in _OPENERS:
                self._tokens.append(token)
        self._index = 0
        self._gaps = _gaps(source.text, self._tokens, comments)

    @property
    def kind(self) -> str:
        """Kind of the next token."""
        return self._next.type

    @property
    def start(self) -> int:
        """Offset of the next token."""
        return self._next.start_pos

    @property
    def _next(self) -> Token:
        return self._tokens[self._index] if self._index < len(self._tokens) else _END

    @property
    def column(self) -> int:
        """Column of the next token in the text, counted from 0."""
        return self._source.line_and_column(self.start)[1] - 1

    @property
    def has_comments(self) -> bool:
        """Whether comments stand before the next token."""
        return bool(self._gaps[self._index].remarks)

    @property
    def on_new_line(self) -> bool:
        """Whether the next token stands on a later line than the one before."""
        before = self._tokens[self._index - 1].end_pos or 0 if self._index else 0
        return "\n" in self._source.text[before : self.start]

    @property
    def after_blank_line(self) -> bool:
        """Whether an empty line stands right before the next token."""
        return self._gaps[self._index].last > 1

    def word(self, *kinds: str) -> Doc:
        """Take a keyword, in capitals, or a sign; one of `kinds`."""
        if self.kind not in kinds:
            raise UnexpectedToken(f"{self.kind} instead of {' or '.join(kinds)}")
        return self._take(self.kind if self._next[0].isalpha() else str(self._next))

    def spelled(self) -> Doc:
        """Take a name or a literal as it is."""
        return self._take(str(self._next))

    def optional(self, kind: str) -> Doc:
        """Take a sign or keyword where it stands, else nothing."""
        return self.word(kind) if self.kind == kind else ""

    def drop(self) -> None:
        """Leave a token out; its comments go to the next one."""
        here, after = self._gaps[self._index], self._gaps[self._index + 1]
        after.remarks[:0] = here.remarks
        after.line_ends[:0] = here.line_ends
        self._index += 1

    def leading(self) -> list[tuple[bool, Remark]]:
        """Take the comments on lines of their own before the next token; with each, whether a blank line
        stands before it."""
        gap, found = self._gaps[self._index], []
        while gap.remarks and gap.remarks[0].where == "own":
            remark = gap.remarks.pop(0)
            found.append((gap.line_ends.pop(0) > 1, Remark(remark.text, remark.column, "line")))
        return found

    def _take(self, text: str) -> Doc:
        if self._next is _END:
            raise UnexpectedToken("the end of the text")
        before, after = self._gaps[self._index], self._gaps[self._index + 1]
        self._index += 1
        lead = tuple(before.remarks)
        before.remarks.clear()
        ends: list[Remark] = []
        while after.remarks and after.remarks[0].where == "end":
            ends.append(after.remarks.pop(0))
            after.line_ends.pop(0)
        return (*lead, text, *ends) if lead or ends else text


def _gaps(text: str, tokens: Sequence[Token], comments: Sequence[Span]) -> list[_Gap]:
    """What stands before each token, and behind the last one."""
    gaps = []
    index = end = 0
    previous = ""
    for token in (*tokens, _END):
        start = len(text) if token is _END else token.start_pos
        inside = []
        while index < len(comments) and comments[index].start < start:
            inside.append(comments[index])
            index += 1
        if inside:
            gaps.append(_gap(text, Span(end, start), inside, previous, token is _END))
        else:
            gaps.append(_Gap(last=text.count("\n", end, start)))
        end, previous = token.end_pos, token.type
    return gaps


def _gap(text: str, span: Span, comments: Sequence[Span], previous: str, at_end: bool) -> _Gap:
    gap = _Gap()
    end = span.start
    for first, last in _on_one_line(text, comments):
        begins_line = "\n" in text[end : first.start] or not previous
        before = text[end : first.start].count("\n")
        end = last.end
        after = next((one.start for one in comments if one.start >= end), span.end)
        ends_line = "\n" in text[end:after] or (at_end and after == span.end)
        where = _where(begins_line, ends_line, previous)
        words = " ".join(
            text[one.start : one.end] for one in comments if first.start <= one.start <= last.start
        )
        column = first.start - (text.rfind("\n", 0, first.start) + 1)
        gap.remarks.append(Remark(words, column, where))
        gap.line_ends.append(before)
        previous = "COMMENT"
    gap.last = text[end : span.end].count("\n")
    return gap


def _on_one_line(text: str, comments: Sequence[Span]) -> list[tuple[Span, Span]]:
    """First and last of the comments that follow each other on one line."""
    runs: list[tuple[Span, Span]] = []
    for comment in comments:
        if runs and "\n" not in text[runs[-1][1].end : comment.start]:
            runs[-1] = runs[-1][0], comment
        else:
            runs.append((comment, comment))
    return runs


def _where(begins_line: bool, ends_line: bool, previous: str) -> Literal["inline", "end", "own"]:
    if begins_line:
        return "own" if ends_line else "inline"
    return "end" if ends_line or previous in BOUNDARIES else "inline"
