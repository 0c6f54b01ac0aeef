"""Which marks of moves are drawn, and which of them are told their program line."""

from __future__ import annotations

from collections.abc import Sequence

from irlx.report.plot.curves import MoveMark

_CROWD, _MOST = 2.0, 8
"""Marks with less than so many gaps between them are a crowd, and so many of one are drawn at most."""


def spaced_marks(marks: Sequence[MoveMark], gap: float) -> list[MoveMark]:
    """Marks that stand at least `gap` (s) apart, in their order.

    Of many short moves, which would be as good as a grid, those that first reach a line, and the last one.
    """
    found: list[MoveMark] = []
    for crowd in _crowds(marks, _CROWD * gap):
        for some in (crowd, _firsts(crowd), [crowd[0], crowd[-1]]):
            apart = _apart(some, gap)
            if len(apart) <= _MOST:
                break
        found += apart
    return found


def told_marks(marks: Sequence[MoveMark], room: float) -> list[MoveMark]:
    """Marks above which there is `room` (s) for their line, one of those that follow each other with the
    same line."""
    found: list[MoveMark] = []
    for mark in marks:
        if not found or (mark.line != found[-1].line and mark.time - found[-1].time >= room):
            found.append(mark)
    return found


def _crowds(marks: Sequence[MoveMark], within: float) -> list[list[MoveMark]]:
    """Marks in groups of those that follow each other within a time, s."""
    found: list[list[MoveMark]] = []
    for mark in marks:
        if found and mark.time - found[-1][-1].time < within:
            found[-1].append(mark)
        else:
            found.append([mark])
    return found


def _firsts(crowd: Sequence[MoveMark]) -> list[MoveMark]:
    """The first mark of each line, and the last one of all."""
    first = {mark.line: mark for mark in reversed(crowd)}
    return [mark for mark in crowd if mark is first[mark.line] or mark is crowd[-1]]


def _apart(marks: Sequence[MoveMark], gap: float) -> list[MoveMark]:
    """The first mark, and always the next one that is `gap` or more behind."""
    found: list[MoveMark] = []
    for mark in marks:
        if not found or mark.time - found[-1].time >= gap:
            found.append(mark)
    return found
