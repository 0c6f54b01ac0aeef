"""Where something is: text of a file, a range of offsets in it, or a key in a structured file."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field
from functools import cached_property


@dataclass(frozen=True, slots=True)
class Span:
    """Half-open range ``[start, end)`` of character offsets in a `SourceText`."""

    start: int
    end: int

    def __post_init__(self) -> None:
        if not 0 <= self.start <= self.end:
            raise ValueError(f"a span needs 0 <= start <= end, found {self.start}..{self.end}")

    def to(self, other: Span) -> Span:
        """Smallest span that covers this one and `other`."""
        return Span(min(self.start, other.start), max(self.end, other.end))


@dataclass(frozen=True)
class SourceText:
    """Text of one program file after normalisation; offsets of spans count in `text`."""

    name: str
    text: str = field(repr=False)

    @cached_property
    def _line_starts(self) -> list[int]:
        starts = [0]
        starts.extend(i + 1 for i, character in enumerate(self.text) if character == "\n")
        return starts

    def line_and_column(self, offset: int) -> tuple[int, int]:
        """Line and column of an offset, both counted from 1."""
        offset = min(max(offset, 0), len(self.text))
        line = bisect_right(self._line_starts, offset)
        return line, offset - self._line_starts[line - 1] + 1

    def line_text(self, line: int) -> str:
        """Text of a line (counted from 1) without its end."""
        start = self._line_starts[line - 1]
        end = self._line_starts[line] - 1 if line < len(self._line_starts) else len(self.text)
        return self.text[start:end].rstrip("\r")

    @property
    def line_count(self) -> int:
        """Number of lines; an empty text has one."""
        return len(self._line_starts)


@dataclass(frozen=True)
class Place:
    """Where a diagnostic points: a file, and in it either a span of text or a key path.

    `key` names a place in a file that is not a program: ``robot.limits.speed[3]``, ``record 17``.
    """

    file: str
    span: Span | None = None
    text: SourceText | None = field(default=None, repr=False, compare=False)
    key: str = ""

    @classmethod
    def in_text(cls, text: SourceText, span: Span) -> Place:
        """Place of a span in a program text."""
        return cls(text.name, span, text)

    @property
    def line(self) -> int | None:
        """Line counted from 1, or None where the place is no text."""
        return self.line_and_column[0] if self.line_and_column else None

    @property
    def line_and_column(self) -> tuple[int, int] | None:
        """Line and column counted from 1, or None where the place is no text."""
        if self.text is None or self.span is None:
            return None
        return self.text.line_and_column(self.span.start)

    @property
    def end_line_and_column(self) -> tuple[int, int] | None:
        """Line and column just after the last character, or None where the place is no text."""
        if self.text is None or self.span is None:
            return None
        return self.text.line_and_column(self.span.end)

    def __str__(self) -> str:
        if self.line_and_column is not None:
            line, column = self.line_and_column
            return f"{self.file}:{line}:{column}"
        return f"{self.file}: {self.key}" if self.key else self.file
