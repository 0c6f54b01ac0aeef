"""Documents in the manner of Wadler and Prettier: what a text may look like, before its lines are chosen.

A document is a `str` without line ends, a tuple of documents one after the other, or one of the classes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

__all__ = ["HARD", "Doc", "Fill", "Group", "Hard", "Here", "Indent", "Line", "Pad", "Remark", "separated"]


@dataclass(frozen=True)
class Line:
    """A line end where the group around it is broken, else `flat`."""

    flat: str = " "


@dataclass(frozen=True)
class Hard:
    """A line end always."""


@dataclass(frozen=True)
class Indent:
    """New lines in `doc` begin two columns further right."""

    doc: Doc


@dataclass(frozen=True)
class Here:
    """New lines in `doc` begin at the column where it begins."""

    doc: Doc


@dataclass(frozen=True)
class Group:
    """On one line where it fits and `broken` does not forbid it; else every `Line` in it is a line end."""

    doc: Doc
    broken: bool = False


@dataclass(frozen=True)
class Fill:
    """Items with blanks between, and a line end in place of a blank only where the next does not fit."""

    items: tuple[Doc, ...]


@dataclass
class Pad:
    """Blanks whose number is known once what stands in the lines around is."""

    width: int = 0


@dataclass(frozen=True)
class Remark:
    """A comment as the text had it, and the column where it began there.

    `where`: ``line`` stands where a line begins, ``inline`` between two words of a line, ``end`` behind all
    that its line holds, ``own`` wants a line of its own and gets it where one begins, else is inline.
    """

    text: str
    column: int
    where: Literal["line", "inline", "end", "own"]


Doc: TypeAlias = "str | tuple[Doc, ...] | Line | Hard | Indent | Here | Group | Fill | Pad | Remark"

HARD = Hard()


def separated(items: Sequence[Doc], line: Doc = Line()) -> Doc:
    """Items with `line` between them."""
    parts: list[Doc] = []
    for item in items:
        parts += [line, item] if parts else [item]
    return tuple(parts)
