"""Lines of a report for people: a label, words, and what the line is about."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import Enum

__all__ = ["LABEL", "Line", "Tone", "columns", "plain_text", "under"]

LABEL = 12
"""Columns that labels take."""


class Tone(Enum):
    """What a line tells: all is well, something is at fault, time was lost, or just a figure."""

    GOOD = "good"
    BAD = "bad"
    CARE = "care"
    FIGURE = "figure"


@dataclass(frozen=True)
class Line:
    """A line of a report: `label` is '' where it goes on with the line before, None in a headline."""

    label: str | None
    words: str
    tone: Tone = Tone.FIGURE

    @property
    def plain(self) -> str:
        """The line without colour or marks."""
        return self.words if self.label is None else f"{self.label:<{LABEL}}{self.words}".rstrip()


def under(label: str, entries: Iterable[str], tone: Tone = Tone.FIGURE) -> list[Line]:
    """Lines of one label, which stands before the first of them alone."""
    return [Line("" if number else label, words, tone) for number, words in enumerate(entries)]


def columns(rows: Sequence[Sequence[str]], right: Sequence[int] = ()) -> list[str]:
    """Rows of as many cells each as lines, columns below each other; those of the numbers `right` end so."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        "  ".join(
            cell.rjust(width) if number in right else cell.ljust(width)
            for number, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]


def plain_text(lines: Iterable[Line]) -> str:
    """Lines as a text without colour, which ends without a line end."""
    return "\n".join(line.plain for line in lines)
