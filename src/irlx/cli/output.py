"""Diagnostics on stderr, results on stdout, and the exit code that belongs to them."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Sequence

from irlx.diagnostics import Diagnostic
from irlx.diagnostics.text import render_text

_COLOURS = {"error": "\x1b[1;31m", "warning": "\x1b[1;33m", "info": "\x1b[1;36m"}
_PLAIN = "\x1b[0m"
_USAGE = frozenset({"IRL707", "IRL720"})
"""Codes beyond IRL0xx and IRL6xx that say that a file was wrongly named, or a package is missing."""


def coloured(stream: object) -> bool:
    """Whether colour may be used on a text stream: a terminal, and NO_COLOR not set."""
    is_terminal = getattr(stream, "isatty", lambda: False)()
    return bool(is_terminal) and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"


def print_diagnostics(diagnostics: Iterable[Diagnostic]) -> None:
    """Print each diagnostic with its place and excerpt on stderr."""
    colour = coloured(sys.stderr)
    for diagnostic in diagnostics:
        text = render_text(diagnostic)
        if colour:
            words = f"{diagnostic.severity.value} {diagnostic.code}"
            text = text.replace(words, f"{_COLOURS[diagnostic.severity.value]}{words}{_PLAIN}", 1)
        print(encodable(text, sys.stderr), file=sys.stderr)


def encodable(text: str, stream: object) -> str:
    """The text with characters that the stream's encoding lacks written as escapes."""
    encoding = getattr(stream, "encoding", None) or "utf-8"
    return text.encode(encoding, "backslashreplace").decode(encoding)


def exit_code(diagnostics: Sequence[Diagnostic]) -> int:
    """0 without errors; 2 where files, command line or cell are at fault; else 1."""
    errors = [diagnostic for diagnostic in diagnostics if diagnostic.is_error]
    if not errors:
        return 0
    return 2 if any(error.code[3] in "06" or error.code in _USAGE for error in errors) else 1
