"""In which rows a stream keeps clear of what."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import ObstacleBlock
from irlx.scene.scene import Scene
from irlx.streams.joint_stream import Integers
from irlx.verifier.outline import Outline

Spans = Mapping[str, tuple[tuple[int, int], ...]]
"""First and last row of every stretch in which an obstacle counts, by its casefolded name."""


def obstacle_spans(outline: Outline, scene: Scene) -> tuple[Spans, tuple[str, ...]]:
    """Spans of the obstacles that a stream keeps clear of, and the names that the scene does not know.

    A block recorded at tick k counts from row k + 1 on. A name is on or off, however often it was called; an
    obstacle counts as long as its own name or that of any group of it is on.
    """
    found: dict[str, list[tuple[int, int]]] = {}
    unknown: list[str] = []
    on: dict[str, tuple[str, ...]] = {}
    since = 0
    switches = [
        (record.tick, record.block) for record in outline.records if isinstance(record.block, ObstacleBlock)
    ]
    for tick, block in switches:
        _count(found, on, since, tick)
        since = tick
        key = block.name.casefold()
        try:
            members = tuple(obstacle.name.casefold() for obstacle in scene.members(block.name))
        except KeyError:
            unknown += [block.name] if block.name not in unknown else []
            continue
        on.pop(key, None)
        if block.active:
            on[key] = members
    _count(found, on, since, outline.rows - 1)
    return {name: tuple(spans) for name, spans in found.items()}, tuple(unknown)


def _count(
    found: dict[str, list[tuple[int, int]]], on: Mapping[str, tuple[str, ...]], since: int, until: int
) -> None:
    """Add the rows behind `since` up to `until` for all that is on; they continue those that end there."""
    if until <= since:
        return
    for name in {name for members in on.values() for name in members}:
        spans = found.setdefault(name, [])
        if spans and spans[-1][1] == since:
            spans[-1] = spans[-1][0], until
        else:
            spans.append((since + 1, until))


def rows_in(spans: tuple[tuple[int, int], ...], rows: Integers) -> NDArray[np.bool_]:
    """Which of rows (K,) are in any of the spans."""
    found = np.zeros(len(rows), dtype=np.bool_)
    for first, last in spans:
        found |= (rows >= first) & (rows <= last)
    return found
