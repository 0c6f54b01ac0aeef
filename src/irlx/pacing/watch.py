"""Whoever wants to see how a run comes on, while a move takes its time."""

from __future__ import annotations

from typing import Protocol

from irlx.blocks import Block


class Watch(Protocol):
    """Told what is being worked on; called for every tick or for some, so that it should return at once."""

    def begins(self, block: Block, tick: int) -> None:
        """A motion begins, its robot at rest at a tick: that of `block`, and of moves joined to it."""

    def ticked(self, tick: int) -> None:
        """Rows from a tick on are being solved; may be a tick of before, where it is solved again."""

    def plans(self) -> None:
        """The motion is being planned as a whole, which may take seconds and counts no ticks."""
