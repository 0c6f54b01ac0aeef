"""The frames of a replay, made of the rows of a run as these come."""

from __future__ import annotations

from math import ceil
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

MOST_PER_SECOND = 50
MOST_FRAMES = 12_000
"""Frames of a page: four minutes at the most a second, coarser beyond."""


class Columns(NamedTuple):
    """M rows, or M frames, each with what was extreme in the ticks since the one before.

    State at the `tick` (M,): `line` of the program (M,), joint values `q` (M, n), pose of the `tool` (M, 7).
    Largest in size since the row before: `speed` of the joints (M, n), `tool_speed` (M,) m/s, `turn_speed`
    (M,) rad/s. The place with the least `room` (M,) m above its margin: its `distance` (M,) m and the number
    of its `pair` (M,); infinite and -1 where everything is far. `watched` (M,): anything was kept clear.
    """

    tick: Integers
    line: Integers
    q: Array
    tool: Array
    speed: Array
    tool_speed: Array
    turn_speed: Array
    room: Array
    distance: Array
    pair: Integers
    watched: NDArray[np.bool_]


class Frames:
    """Keeps one frame for every `every` ticks, at most 50 a second and at most `most` in all.

    Where more come, two become one: memory stays bounded however long a run lasts. Frames are at ticks
    that are multiples of `every`, and at the last tick. Nothing extreme is lost: see `Columns`.
    """

    def __init__(self, dt: float, most: int = MOST_FRAMES) -> None:
        self.every = max(1, ceil(1.0 / (MOST_PER_SECOND * dt) - 1e-9))
        self._most = max(most, 2)
        self._parts: list[Columns] = []
        self._count = 0

    def take(self, rows: Columns) -> None:
        """Take the next rows, one a tick."""
        if self._parts and int(self._parts[-1].tick[-1]) % self.every:
            # The last frame is not over yet.
            before = self._parts.pop()
            if len(before.tick) > 1:
                self._parts.append(_part(before, slice(0, -1)))
            rows = _joined([_part(before, slice(-1, None)), rows])
            self._count -= 1
        self._put(_binned(rows, self.every))
        while self._count > self._most:
            self.every *= 2
            whole, self._parts, self._count = _joined(self._parts), [], 0
            self._put(_binned(whole, self.every))

    def _put(self, frames: Columns) -> None:
        self._parts.append(frames)
        self._count += len(frames.tick)

    @property
    def columns(self) -> Columns:
        """All frames so far."""
        return _joined(self._parts)


def _part(rows: Columns, part: slice) -> Columns:
    return Columns._make(column[part] for column in rows)


def _joined(parts: list[Columns]) -> Columns:
    if len(parts) == 1:
        return parts[0]
    return Columns._make(np.concatenate(column) for column in zip(*parts, strict=True))


def _binned(rows: Columns, every: int) -> Columns:
    """Frames at the ticks that are multiples of `every`, and at the last one."""
    if every == 1:
        return rows
    number = -(-rows.tick // every)
    first = np.flatnonzero(np.append(True, number[1:] != number[:-1]))
    last = np.append(first[1:], len(number)) - 1
    # Sorted by frame, then by room: the first of each frame has the least.
    least = np.lexsort((rows.room, number))[first]
    return Columns(
        rows.tick[last],
        rows.line[last],
        rows.q[last],
        rows.tool[last],
        _largest(rows.speed, first),
        np.maximum.reduceat(rows.tool_speed, first),
        np.maximum.reduceat(rows.turn_speed, first),
        rows.room[least],
        rows.distance[least],
        rows.pair[least],
        np.logical_or.reduceat(rows.watched, first),
    )


def _largest(values: Array, first: NDArray[np.intp]) -> Array:
    """Of rows (M, n) in groups that begin at `first` the values largest in size, with their signs."""
    highest, lowest = np.maximum.reduceat(values, first), np.minimum.reduceat(values, first)
    return np.where(-lowest > highest, lowest, highest)
