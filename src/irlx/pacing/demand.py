"""What one tick asks of the inverse transform, and what may change it on the way there."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from typing import NamedTuple, overload

import numpy as np
from numpy.typing import NDArray

from irlx.motion.pose_path import PosePath
from irlx.pacing.clock import Clock

Array = NDArray[np.float64]


class Demand(NamedTuple):
    """Tool pose asked for at a tick.

    `tick` counts from the start of the stream, `s` is the path parameter; `position` (3,) m,
    `rotation` (3, 3), `twist` (6,) (m/s, rad/s) of the tool in the world.
    """

    tick: int
    s: float
    position: Array
    rotation: Array
    twist: Array


DemandModifier = Callable[[Demand], Demand]
"""Changes a demand before the inverse transform sees it: a sensor's correction, for example."""


@dataclass(frozen=True, eq=False)
class Demands(Sequence[Demand]):
    """The demands of N ticks as arrays: `tick` (N,), `s` (N,), `position` (N, 3), `rotation` (N, 3, 3) and
    `twist` (N, 6), see `Demand`. A slice of them is of the same kind."""

    tick: NDArray[np.int64]
    s: Array
    position: Array
    rotation: Array
    twist: Array

    @classmethod
    def of(cls, demands: Iterable[Demand]) -> Demands:
        """Demands of ticks one by one."""
        if isinstance(demands, Demands):
            return demands
        found = list(demands)
        if not found:
            return cls(np.zeros(0, np.int64), *(np.zeros((0, *shape)) for shape in ((), (3,), (3, 3), (6,))))
        tick, s, position, rotation, twist = zip(*found, strict=True)
        rows = np.array(s, dtype=np.float64), np.array(position), np.array(rotation), np.array(twist)
        return cls(np.array(tick, dtype=np.int64), *rows)

    @classmethod
    def joined(cls, *parts: Demands) -> Demands:
        """Demands of several stretches of ticks, one behind the other."""
        tick, *columns = zip(*(part._columns for part in parts), strict=True)
        return cls(np.concatenate(tick), *(np.concatenate(column) for column in columns))

    @property
    def _columns(self) -> tuple[NDArray[np.int64], Array, Array, Array, Array]:
        return self.tick, self.s, self.position, self.rotation, self.twist

    def __len__(self) -> int:
        return len(self.s)

    @overload
    def __getitem__(self, row: int) -> Demand: ...
    @overload
    def __getitem__(self, row: slice) -> Demands: ...
    def __getitem__(self, row: int | slice) -> Demand | Demands:
        if isinstance(row, slice):
            return self._taken(row)
        pose = self.position[row], self.rotation[row]
        return Demand(int(self.tick[row]), float(self.s[row]), *pose, self.twist[row])

    def __iter__(self) -> Iterator[Demand]:
        columns = self.tick.tolist(), self.s.tolist(), self.position, self.rotation, self.twist
        return map(Demand, *columns)

    def later(self, ticks: int | NDArray[np.int64]) -> Demands:
        """The same demands so many ticks later, all alike or each by its own number."""
        return replace(self, tick=self.tick + ticks)

    def repeated(self, row: int, count: int) -> Demands:
        """The demand of a row so many times."""
        return self._taken(np.full(count, row))

    def _taken(self, rows: slice | NDArray[np.intp]) -> Demands:
        tick, *columns = self._columns
        return Demands(tick[rows], *(column[rows] for column in columns))


def demands(
    path: PosePath, clock: Clock, first_tick: int, modifiers: Sequence[DemandModifier] = ()
) -> Demands:
    """Demands of a motion in tick order; poses are computed as arrays, modified one by one."""
    poses = path.poses(clock.s)
    along, turning = path.derivatives(clock.s)
    twists = np.hstack([along, turning]) * clock.rate[:, None]
    # As round() does: to the even one half way.
    ticks = np.rint(np.arange(1.0, len(clock) + 1.0) * clock.ticks_a_row).astype(np.int64) + (first_tick - 1)
    found = Demands(ticks, clock.s, poses.position, poses.rotation, twists)
    return Demands.of(_modified(found, modifiers)) if modifiers else found


def _modified(asked: Iterable[Demand], modifiers: Sequence[DemandModifier]) -> Iterator[Demand]:
    for demand in asked:
        yield reduce(lambda changed, modify: modify(changed), modifiers, demand)
