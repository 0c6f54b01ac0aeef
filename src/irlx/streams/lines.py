"""Lines of files of strangers: none is longer than what somebody may have meant."""

from __future__ import annotations

import errno
import io
from collections.abc import Iterator
from typing import IO

LONGEST_LINE = 1 << 26
"""Bytes: a path of some hundred thousand points in one record."""


def next_line(handle: IO[bytes]) -> bytes:
    """The next line with its end, b'' behind the last one. Raises OSError for one that is longer."""
    line = handle.readline(LONGEST_LINE + 1)
    if len(line) > LONGEST_LINE:
        raise OSError(errno.EFBIG, f"it has a line of more than {LONGEST_LINE:,} bytes")
    return line


def all_lines(handle: IO[bytes]) -> Iterator[bytes]:
    """All lines, one after the other; raises as `next_line`."""
    while line := next_line(handle):
        yield line


def portions(handle: IO[bytes], size: int) -> Iterator[list[bytes]]:
    """All lines, in portions of about `size` bytes; raises as `next_line`."""
    while data := handle.read(size):
        if not data.endswith(b"\n"):
            data += next_line(handle)
        yield io.BytesIO(data).readlines()
