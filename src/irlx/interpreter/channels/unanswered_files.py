"""Files of a program that is only followed: nothing is written, and nobody knows what it read."""

from __future__ import annotations

from collections.abc import Callable, Hashable

from irlx.interpreter.channels.files import Files, Mode, Opened


class UnansweredFiles(Files):
    """Every file opens; writing does nothing, and `unknown` is called for what would be read: it raises."""

    def __init__(self, unknown: Callable[[], str]) -> None:
        self._unknown = unknown

    def open(self, name: str, mode: Mode, busy: Callable[[Hashable], None]) -> Opened:
        """Open a file; raises nothing."""
        if mode == "READ":
            return Opened(object(), self._unknown)
        return Opened(object(), sink=_Nowhere())


class _Nowhere:
    def write(self, data: bytes) -> None:
        """Write nothing."""

    def close(self) -> None:
        """Close nothing."""
