"""Stdin, stdout and stderr of the process, whatever they are: closed, full, a pipe without reader."""

from __future__ import annotations

import io
import os
import select
import sys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer

__all__ = ["OutputLost", "drop_output", "take_channels"]

_NUMBERS = {"stdin": 0, "stdout": 1, "stderr": 2}


class OutputLost(OSError):
    """Stdout cannot be written; what follows is dropped."""


def take_channels() -> None:
    """Make the three channels of this process such that commands need not care for their state.

    Those that are closed lead to the null device: nobody wants to see or say anything, and no file that is
    opened later gets their numbers. A stderr that cannot be written is let go: what cannot be told is no
    reason to end otherwise. A stdout that cannot be written raises OutputLost, once; one whose reader
    went away raises BrokenPipeError, as ever.
    """
    for name, number in _NUMBERS.items():
        if getattr(sys, name) is None:
            _reserve(number)
            mode = "r" if name == "stdin" else "w"
            setattr(sys, name, open(number, mode, encoding="utf-8", closefd=False))  # noqa: SIM115
    for name in ("stdout", "stderr"):
        channel = getattr(sys, name)
        # Somebody who put another stream there knows better.
        if isinstance(channel, io.TextIOWrapper) and _descriptor(channel) == _NUMBERS[name]:
            setattr(sys, name, _over_descriptor(channel, _NUMBERS[name]))


def drop_output(number: int = 1) -> None:
    """Let everything that is written to a channel go to the null device from now on."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, number)
    os.close(nowhere)


def _reserve(number: int) -> None:
    """Let the number of a closed channel stand for the null device."""
    try:
        os.fstat(number)
    except OSError:
        nowhere = os.open(os.devnull, os.O_RDWR)
        if nowhere != number:
            os.dup2(nowhere, number)
            os.close(nowhere)


def _descriptor(channel: io.TextIOWrapper) -> int | None:
    try:
        return channel.fileno()
    except (OSError, ValueError):
        return None


def _over_descriptor(like: io.TextIOWrapper, number: int) -> io.TextIOWrapper:
    """A text stream like another one, over what knows how to fail."""
    like.flush()
    raw = _Descriptor(number)
    # With -u nothing is kept, as by Python itself.
    buffer: Any = raw if like.write_through else io.BufferedWriter(raw)
    return io.TextIOWrapper(
        buffer,
        encoding=like.encoding,
        errors=like.errors,
        line_buffering=like.line_buffering,
        write_through=like.write_through,
    )


class _Descriptor(io.FileIO):
    """The descriptor of stdout or stderr, which stays open."""

    def __init__(self, number: int) -> None:
        super().__init__(number, "wb", closefd=False)

    def write(self, data: ReadableBuffer, /) -> Any:
        """Write all of it; waits where the other side has made the descriptor one that does not."""
        left = memoryview(data).cast("B")
        size = left.nbytes
        try:
            while left:
                written = super().write(left)
                if written is None:
                    select.select([], [self], [])
                else:
                    left = left[written:]
        except OSError as cause:
            if isinstance(cause, BrokenPipeError) and self.fileno() == _NUMBERS["stdout"]:
                raise
            drop_output(self.fileno())
            if self.fileno() == _NUMBERS["stdout"]:
                raise OutputLost(cause.errno, cause.strerror) from cause
        return size
