"""Programs and cells of many verifications are read once each: what they say depends on their bytes alone."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import pytest

from irlx import verification


@pytest.fixture(scope="module")
def read_once() -> Iterator[None]:
    """For modules whose programs import nothing, and whose cells name a packaged robot."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(verification, "load_cell", _of_bytes(verification.load_cell))
        patch.setattr(verification, "load", _of_bytes(verification.load))
        yield


def _of_bytes(read: Callable) -> Callable:
    @cache
    def known(path: Path, content: bytes, others: tuple) -> object:
        return read(path, *(one[0] if one else None for one in others))

    def reading(path: Path, *others: Path | None) -> object:
        """The files themselves are looked at each time."""
        given = tuple(other and (Path(other), Path(other).read_bytes()) for other in others)
        return known(Path(path), Path(path).read_bytes(), given)

    return reading
