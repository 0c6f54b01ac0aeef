"""From where the routines were called whose moves are under way: errors of these are told with it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from irlx.blocks import Block, MoveBlock, Origin
from irlx.diagnostics import IrlxError, Place
from irlx.diagnostics.diagnostic import Related

_KEPT = 512
"""Moves that are remembered: more than are ever joined."""


class Called:
    """Calls that led to the last moves, by the ids of these."""

    def __init__(self) -> None:
        self._calls: dict[int, tuple[Place, ...]] = {}

    def take(self, block: Block, calls: tuple[Place, ...]) -> None:
        """Take a block that comes while some `calls` are under way, the innermost first."""
        if not calls or not isinstance(block, MoveBlock):
            return
        self._calls[block.id] = calls
        if len(self._calls) > _KEPT:
            del self._calls[next(iter(self._calls))]

    def tell(self, error: IrlxError, blocks: Sequence[Block], locate: Callable[[Origin], Place]) -> None:
        """Add to errors at one of some blocks from where it was called.

        Nothing is added where several of them are at that place and were called from different ones.
        """
        told = []
        for one in error.diagnostics:
            here = [block for block in blocks if one.place == locate(block.origin)]
            calls = {self._calls.get(block.id, ()) for block in here}
            places = calls.pop() if one.is_error and len(calls) == 1 else ()
            related = (*one.related, *(Related("called here", place) for place in places))
            told.append(replace(one, related=related))
        error.diagnostics = tuple(told)
