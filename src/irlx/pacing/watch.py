"""Whoever wants to see how a run comes on, while a move takes its time."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Protocol

from irlx.blocks import Block
from irlx.pacing.demand import Demand


class Watch(Protocol):
    """Told what is being worked on; called for every tick, so that it should return at once."""

    def begins(self, block: Block, tick: int) -> None:
        """A motion begins, its robot at rest at a tick: that of `block`, and of moves joined to it."""

    def ticked(self, tick: int) -> None:
        """The row of a tick is being solved; may be a tick of before, where it is solved again."""

    def plans(self) -> None:
        """The motion is being planned as a whole, which may take seconds and counts no ticks."""


def watched(demands: Iterable[Demand], watch: Watch | None) -> Iterable[Demand]:
    """The same demands, each told to whoever watches."""
    return demands if watch is None else _told(demands, watch)


def _told(demands: Iterable[Demand], watch: Watch) -> Iterator[Demand]:
    for demand in demands:
        watch.ticked(demand.tick)
        yield demand
