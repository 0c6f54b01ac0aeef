"""Text to tokens and comments, with the mistakes that single characters make."""

from __future__ import annotations

from dataclasses import dataclass
from math import isinf
from typing import Any

from lark import Token

from irlx.diagnostics import Diagnostic, Place, SourceText, Span, report
from irlx.language.comments import opens_another, repaired
from irlx.language.grammar import load_grammar

__all__ = ["Lexed", "is_open_string", "lex", "token_span"]

LARGEST_INT = 2**63 - 1
_SIGNS = {
    "==": ("EQUAL", "="),
    "!=": ("UNEQUAL", "<>"),
    "=<": ("LESS_EQUAL", "<="),
    "=>": ("GREATER_EQUAL", ">="),
    "&&": ("AND", "AND"),
    "||": ("OR", "OR"),
}
_LITERALS = frozenset({"STRING", "INT", "REAL"})
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
    return Span(token.start_pos or 0, token.end_pos or 0)


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
        take = self.tokens.append
        for token in load_grammar().lex(text):
            kind = token.type
            if kind in _TAKEN_OUT:
                self._taken_out(token)
                continue
            take(token)
            if kind in _LITERALS:
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
            self._wrong_until = token.end_pos or 0

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
            if len(digits) > 19 or (digits and int(digits) > LARGEST_INT + 1):
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
