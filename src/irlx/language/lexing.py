"""Text to tokens and comments, with the mistakes that single characters make."""

from __future__ import annotations

from dataclasses import dataclass
from math import isinf
from typing import Any

from lark import Token

from irlx.diagnostics import Diagnostic, Place, SourceText, Span, report
from irlx.language.grammar import load_grammar

__all__ = ["Lexed", "lex", "token_span"]

LARGEST_INT = 2**63 - 1


@dataclass(frozen=True)
class Lexed:
    """Tokens without comments, comments, findings, and the tokens after which a string was left open."""

    tokens: tuple[Token, ...]
    comments: tuple[Span, ...]
    findings: tuple[Diagnostic, ...]


def token_span(token: Token) -> Span:
    """Span of a token."""
    return Span(token.start_pos or 0, token.end_pos or 0)


def is_open_string(token: Token) -> bool:
    """Whether a STRING token ends without its quote."""
    return token.count(token[0]) % 2 == 1


def lex(source: SourceText) -> Lexed:
    """Split a text; never fails, characters that mean nothing are reported and left out."""
    tokens: list[Token] = []
    comments: list[Span] = []
    findings: list[Diagnostic] = []
    wrong_until = -1
    for token in load_grammar().lex(source.text):
        kind = token.type
        if kind == "COMMENT":
            comments.append(token_span(token))
            if not _is_closed_comment(token):
                findings.append(_finding(source, "IRL110", Span(comments[-1].start, comments[-1].start + 1)))
        elif kind == "WRONG_CHARACTER":
            if token.start_pos != wrong_until:
                findings.append(_wrong_character(source, token))
            wrong_until = token.end_pos or 0
        else:
            tokens.append(token)
            if kind in ("STRING", "INT", "REAL"):
                findings.extend(_literal_findings(source, token))
    return Lexed(tuple(tokens), tuple(comments), tuple(findings))


def _finding(source: SourceText, code: str, span: Span, **data: Any) -> Diagnostic:
    return report(code, Place.in_text(source, span), **data)


def _is_closed_comment(token: Token) -> bool:
    if token.startswith("{"):
        return token.endswith("}")
    return len(token) >= 4 and token.endswith("*)")


def _wrong_character(source: SourceText, token: Token) -> Diagnostic:
    number = f"U+{ord(token[0]):04X}"
    shown = f"'{token}' ({number})" if token.isprintable() else number
    return _finding(source, "IRL112", token_span(token), character=shown)


def _literal_findings(source: SourceText, token: Token) -> list[Diagnostic]:
    span = token_span(token)
    if token.type == "STRING":
        if is_open_string(token):
            return [_finding(source, "IRL111", Span(span.start, span.start + 1), quote=token[0])]
    elif token.type == "INT":
        digits = token.lstrip("0")
        # One more than the largest is left to the sign that may stand before it.
        if len(digits) > 19 or (digits and int(digits) > LARGEST_INT + 1):
            return [_finding(source, "IRL113", span, type="INT")]
    elif isinf(float(token)):
        return [_finding(source, "IRL113", span, type="REAL")]
    return []
