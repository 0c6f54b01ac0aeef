"""A smaller case that breaks the same promise: pieces are left out as long as it does."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Sequence

from fuzzing.case import Case

_PIECES = re.compile(rb"[A-Za-z0-9_]+|\s+|.", re.DOTALL)
_MANY = 4000
"""Single bytes are only left out of a case with fewer."""


def smallest(case: Case, breaks: Callable[[Case], bool], seconds: float = 30.0) -> Case:
    """The smallest case found within `seconds` of the clock for which `breaks` says True as for `case`."""
    end = time.monotonic() + seconds
    content = case.content
    for split in (_lines, _words, _bytes):
        pieces = split(content)
        if split is _bytes and len(pieces) > _MANY:
            break
        content = b"".join(_reduced(pieces, lambda part: breaks(Case(case.kind, b"".join(part))), end))
    return Case(case.kind, content)


def _lines(content: bytes) -> list[bytes]:
    return content.splitlines(keepends=True)


def _words(content: bytes) -> list[bytes]:
    return _PIECES.findall(content)


def _bytes(content: bytes) -> list[bytes]:
    return [content[at : at + 1] for at in range(len(content))]


def _reduced(
    pieces: Sequence[bytes], breaks: Callable[[Sequence[bytes]], bool], end: float
) -> Sequence[bytes]:
    """Leave out portions of pieces, large ones first, until no piece is left that may go (ddmin)."""
    size = max(len(pieces) // 2, 1)
    while pieces:
        at, gone = 0, False
        while at < len(pieces):
            if time.monotonic() > end:
                return pieces
            less = [*pieces[:at], *pieces[at + size :]]
            if breaks(less):
                pieces, gone = less, True
            else:
                at += size
        if size == 1 and not gone:
            break
        size = max(size // 2, 1) if not gone or size > 1 else 1
    return pieces
