"""A program that goes wrong while it runs, at a place of its text."""

from __future__ import annotations

from typing import Any

from irlx.diagnostics import IrlxError, Place, SourceText, Span, report


class InterpreterError(IrlxError):
    """A statement or expression that has no meaning or no value."""


def fail(code: str, source: SourceText, span: Span, **data: Any) -> InterpreterError:
    """Error of a code at a span of the program."""
    return InterpreterError(report(code, Place.in_text(source, span), **data))
