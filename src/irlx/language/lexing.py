"""Text to tokens and comments, with the mistakes that single characters make."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache
from math import isinf
from typing import Any

from irlx.diagnostics import Diagnostic, Place, SourceText, Span, report
from irlx.language.comments import opens_another, repaired
from irlx.language.keywords import keyword_table
from irlx.language.ranges import INT_LIMIT
from irlx.language.terminals import terminals
from irlx.language.token import Token

__all__ = ["Lexed", "is_open_string", "lex", "token_span"]

_SIGNS = {
    "==": ("EQUAL", "="),
    "!=": ("UNEQUAL", "<>"),
    "=<": ("LESS_EQUAL", "<="),
    "=>": ("GREATER_EQUAL", ">="),
    "&&": ("AND", "AND"),
    "||": ("OR", "OR"),
}
_LITERALS = frozenset({"STRING", "INT", "REAL"})
_SIGN = "SIGN"
_LAST = frozenset({"WRONG_CHARACTER"})
_TAKEN_OUT = frozenset({"COMMENT", "WRONG_CHARACTER", "FOREIGN_COMMENT", "FOREIGN_SIGN", "FOREIGN_QUOTES"})


@dataclass(frozen=True)
class Lexed:
    """Tokens without comments, comments, and findings.

    `torn` are spans of text that was misread, so that what the parser says there proves nothing; `doubtful`
    says that comments hold the beginning of another one on a later line, so that they may end too late.
    """

    tokens: tuple[Token, ...]
    comments: tuple[Span, ...]
    findings: tuple[Diagnostic, ...]
    torn: tuple[Span, ...] = ()
    doubtful: bool = False


def token_span(token: Token) -> Span:
    """Span of a token."""
    return Span(token.start_pos, token.end_pos)


def is_open_string(token: Token) -> bool:
    """Whether a STRING token ends without its quote."""
    return token.count(token[0]) % 2 == 1


def lex(source: SourceText, *, trust_comments: bool = True) -> Lexed:
    """Split a text; never fails, characters that mean nothing are reported and left out.

    A comment without end, and unless `trust_comments` one that holds the beginning of another, ends
    where code seems to go on.
    """
    text, unclosed = repaired(source.text, trust=trust_comments)
    lexer = _Lexer(source)
    for span in unclosed:
        lexer.comments.append(span)
        lexer.torn.append(span)
        lexer.add("IRL110", Span(span.start, span.start + 1))
    lexer.run(text)
    return Lexed(
        tuple(lexer.tokens),
        tuple(sorted(lexer.comments, key=lambda span: span.start)),
        tuple(lexer.findings),
        tuple(lexer.torn),
        lexer.doubtful,
    )


class _Kinds(dict[str, str]):
    """Terminal of each word that a text has, by how it is spelt there."""

    def __missing__(self, word: str) -> str:
        kind = self[str(word)] = keyword_table().get(word.casefold(), "NAME")
        return kind


@lru_cache(maxsize=1)
def _sign_kinds() -> dict[str, str]:
    return {one.pattern: one.name for one in terminals() if one.is_sign}


@lru_cache(maxsize=1)
def _master() -> re.Pattern[str]:
    """Pattern of space and the lexeme behind it, in a group with the name of its terminal, or the end.

    Most lexemes are words, and nothing else begins with a letter: they are tried first. Signs share a group.
    """
    signs = [re.escape(one.pattern) for one in terminals() if one.is_sign]
    groups = [(one.name, one.pattern) for one in terminals() if not one.is_sign]
    groups.sort(key=lambda group: (group[0] != "NAME", group[0] in _LAST))
    before_last = len(groups) - len(_LAST)
    groups.insert(before_last, (_SIGN, "|".join(signs)))
    return re.compile(rf"\s*(?:{'|'.join(f'(?P<{name}>{pattern})' for name, pattern in groups)}|\Z)")


class _Lexer:
    def __init__(self, source: SourceText) -> None:
        self._source = source
        self._wrong_until = -1
        self.tokens: list[Token] = []
        self.comments: list[Span] = []
        self.findings: list[Diagnostic] = []
        self.torn: list[Span] = []
        self.doubtful = False

    def run(self, text: str) -> None:
        take, signs, kinds = self.tokens.append, _sign_kinds(), _Kinds()
        new = str.__new__
        line, line_start, last = 1, 0, 0
        for match in _master().finditer(text):
            group = match.lastgroup
            if group is None:
                break
            # Named groups end last, so that the last one is the whole lexeme.
            start, end = match.span(group)
            lines = text.count("\n", last, start)
            if lines:
                line += lines
                line_start = text.rfind("\n", last, start) + 1
            last = start
            token = new(Token, match[group])
            token.start_pos = start
            token.end_pos = end
            token.line = line
            token.column = start - line_start + 1
            if group == "NAME":
                token.type = kinds[token]
                take(token)
            elif group == _SIGN:
                token.type = signs[token]
                take(token)
            else:
                token.type = group
                if group in _TAKEN_OUT:
                    self._taken_out(token)
                else:
                    take(token)
                    self._literal(token)

    def add(self, code: str, span: Span, **data: Any) -> None:
        self.findings.append(report(code, Place.in_text(self._source, span), **data))

    def _taken_out(self, token: Token) -> None:
        span, kind = token_span(token), token.type
        if kind == "COMMENT":
            self.comments.append(span)
            other = opens_another(token)
            if other is not None:
                self.doubtful = True
                line, _ = self._source.line_and_column(span.start + other)
                self.add("IRL126", span, line=line)
        elif kind == "FOREIGN_COMMENT":
            self.comments.append(span)
            sign = Span(span.start, span.start + 2)
            self.add("IRL123", sign, found=f"'{token[:2]}'", instead="comments are { .. } or (* .. *)")
        elif kind == "FOREIGN_SIGN":
            meant, sign_here = _SIGNS[token]
            self.add("IRL123", span, found=f"'{token}'", instead=f"write {sign_here}")
            self.tokens.append(_replaced(token, meant, sign_here))
        elif kind == "FOREIGN_QUOTES":
            found = f"the quote {token[0]}"
            self.add("IRL123", span, found=found, instead="a text stands between ' and ', or \" and \"")
            self.tokens.append(_replaced(token, "STRING", _quoted(token[1:-1])))
        else:
            # Several in a row are one mistake.
            if token.start_pos != self._wrong_until:
                self._wrong_character(token)
            self._wrong_until = token.end_pos

    def _wrong_character(self, token: Token) -> None:
        number = f"U+{ord(token[0]):04X}"
        shown = f"'{token}' ({number})" if token.isprintable() else number
        self.torn.append(token_span(token))
        self.add("IRL112", token_span(token), character=shown)

    def _literal(self, token: Token) -> None:
        span = token_span(token)
        if token.type == "STRING":
            if is_open_string(token):
                self.add("IRL111", Span(span.start, span.start + 1), quote=token[0])
        elif token.type == "INT":
            digits = token.lstrip("0")
            # One more than the largest is left to the sign that may stand before it.
            if len(digits) > 19 or (digits and int(digits) > INT_LIMIT):
                self.add("IRL113", span, type="INT")
        elif isinf(float(token)):
            self.add("IRL113", span, type="REAL")


def _replaced(token: Token, kind: str, text: str) -> Token:
    """A token of another kind and text in the place of one."""
    return Token(
        kind, text, start_pos=token.start_pos, end_pos=token.end_pos, line=token.line, column=token.column
    )


def _quoted(text: str) -> str:
    """A text between quotes, as a program writes it."""
    return "'" + text.replace("'", "''") + "'"
