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
