"""How the ticks of a walk begin where those before had to hold their criterion back."""

from __future__ import annotations

LONGEST_WAIT = 64
"""Ticks that at most are held back before one is tried without."""


class HoldingBack:
    """Remembers over the ticks of one walk which restraint (see `Restrained`) the last of them needed.

    Where a tick settles only with its criterion held back, so do many that follow, and to find that out
    takes some hundred Newton steps each time: the next ones begin with what served. After one tick, then
    after 2, 4, ... `LONGEST_WAIT`, one is tried without again: none is held back for long without need.
    """

    def __init__(self) -> None:
        self._restraint = 0.0
        # The first need of a walk is not one that came again.
        self._wait, self._left, self._without = 1, 0, 1

    def begin(self) -> float | None:
        """The restraint that the next tick begins with, None where it begins without."""
        if self._left == 0:
            self._without += 1
            return None
        self._left -= 1
        return self._restraint

    def failed(self) -> None:
        """Note that a tick did not settle with the restraint that it began with: it goes on without."""
        self._left, self._without = 0, 1

    def needed(self, restraint: float) -> None:
        """Note that a tick that was tried without restraint settled with this one."""
        self._wait = min(2 * self._wait, LONGEST_WAIT) if self._without == 1 else 1
        self._restraint, self._left, self._without = restraint, self._wait, 0
