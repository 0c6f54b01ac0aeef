"""Cases of one kind, the first of them in the default run, all of them in the long one (`-m slow`)."""

from __future__ import annotations

from collections.abc import Iterable

import pytest


def first(count: int, cases: Iterable[object]) -> list[object]:
    """The cases for `parametrize`; those behind the first `count` are marked slow."""
    return [
        case if place < count else pytest.param(case, marks=pytest.mark.slow)
        for place, case in enumerate(cases)
    ]


def first_rows(count: int, rows: Iterable[tuple]) -> list[object]:
    """The same for cases that are values of several parameters each."""
    return [
        row if place < count else pytest.param(*row, marks=pytest.mark.slow) for place, row in enumerate(rows)
    ]


def portions(seeds: range, size: int = 20) -> list[range]:
    """The seeds of a long campaign, some at a time: a test for each would cost every run its collection."""
    return [seeds[start : start + size] for start in range(0, len(seeds), size)]


def diagonal(rows: list, columns: Iterable[object], turned: int = 0) -> list[object]:
    """All pairs of a row, a `pytest.param` with an id, and a column; all but a diagonal are marked slow.

    It begins `turned` rows further on. Each row and each column keeps one of its pairs in the default run,
    and those of the shorter side more where they are needed for that.
    """
    ends = list(columns)
    count = min(len(rows), len(ends))
    return [
        pytest.param(
            *row.values,
            column,
            marks=[*row.marks, *([pytest.mark.slow] if (i - j - turned) % count else [])],
            id=f"{row.id}-{column}",
        )
        for i, row in enumerate(rows)
        for j, column in enumerate(ends)
    ]


def chequered(rows: list, columns: Iterable[object]) -> list[object]:
    """All pairs of a row, a `pytest.param` with an id, and a column; every other pair is marked slow.

    Each row and each column keeps half of its pairs in the default run.
    """
    return [
        pytest.param(
            *row.values,
            column,
            marks=[*row.marks, *([pytest.mark.slow] if (i + j) % 2 else [])],
            id=f"{row.id}-{column}",
        )
        for i, row in enumerate(rows)
        for j, column in enumerate(columns)
    ]
