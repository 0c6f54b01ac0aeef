"""Diagnostics on stderr, results on stdout, and the exit code that belongs to them."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, TextIO

if TYPE_CHECKING:
    from rich.text import Text

    from irlx.diagnostics import Diagnostic
    from irlx.report.lines import Line

_COLOURS = {"error": "\x1b[1;31m", "warning": "\x1b[1;33m", "info": "\x1b[1;36m"}
_PLAIN = "\x1b[0m"
_MARKS = {True: "\N{CHECK MARK} ", False: "\N{BALLOT X} "}
_MARK = re.compile(r"^( +\| +)(\^+)$", re.MULTILINE)
"""The line of an excerpt that marks a place in the one above."""
_USAGE = frozenset({"IRL707", "IRL720"})
"""Codes beyond IRL0xx and IRL6xx that say that a file was wrongly named, or a package is missing."""


def coloured(stream: object) -> bool:
    """Whether colour may be used on a text stream: a terminal, and NO_COLOR not set."""
    is_terminal = getattr(stream, "isatty", lambda: False)()
    return bool(is_terminal) and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"


def print_diagnostics(diagnostics: Iterable[Diagnostic]) -> None:
    """Print each diagnostic with its place and excerpt on stderr."""
    from irlx.diagnostics.text import render_text

    render = _in_colours if coloured(sys.stderr) else render_text
    for diagnostic in diagnostics:
        print(encodable(render(diagnostic), sys.stderr), file=sys.stderr)


def _in_colours(diagnostic: Diagnostic) -> str:
    """Text of a diagnostic for a terminal: its code and the mark below the excerpt stand out."""
    from irlx.cli.painting import painted_line
    from irlx.diagnostics.text import render_text

    colour = _COLOURS[diagnostic.severity.value]
    words = f"{diagnostic.severity.value} {diagnostic.code}"
    text = render_text(diagnostic, painted_line).replace(words, f"{colour}{words}{_PLAIN}", 1)
    return _MARK.sub(rf"\g<1>{colour}\g<2>{_PLAIN}", text)


def print_lines(lines: Sequence[Line], stream: TextIO | None = None) -> None:
    """Print lines of a report on a stream, by default stdout; on a terminal with colour and marks."""
    from irlx.report.lines import plain_text

    to = sys.stdout if stream is None else stream
    if not lines:
        return
    if not coloured(to):
        print(encodable(plain_text(lines), to), file=to)
        return
    # Imported here: what reads a pipe wants the text as it is, at once.
    from rich.console import Console

    console = Console(file=to, highlight=False)
    for line in lines:
        console.print(_styled(line, to), soft_wrap=True)


def _styled(line: Line, stream: TextIO) -> Text:
    """A line for a terminal: labels step back, the verdict has a mark and its colour."""
    from rich.text import Text

    from irlx.report.lines import LABEL, Tone

    colour = {Tone.GOOD: "green", Tone.BAD: "red", Tone.CARE: "yellow", Tone.FIGURE: ""}[line.tone]
    words = encodable(line.words, stream)
    if line.label is None and line.tone is Tone.FIGURE:
        return Text(words)
    if line.label is None:
        mark = _MARKS[line.tone is Tone.GOOD]
        # A mark that the terminal has no character for is left out.
        mark = mark if encodable(mark, stream) == mark else ""
        return Text.assemble((f"{mark}{words}", f"bold {colour}"))
    return Text.assemble((f"{line.label:<{LABEL}}", colour or "dim"), words)


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
