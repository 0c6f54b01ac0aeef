"""What one tick asks of the inverse transform, and what may change it on the way there."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

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


def demands(
    path: PosePath, clock: Clock, first_tick: int, modifiers: Sequence[DemandModifier] = ()
) -> Iterator[Demand]:
    """Demands of a motion in tick order; poses are computed as arrays, modified one by one."""
    poses = path.poses(clock.s)
    along, turning = path.derivatives(clock.s)
    twists = np.hstack([along, turning]) * clock.rate[:, None]
    for k in range(len(clock)):
        tick = first_tick - 1 + round((k + 1) * clock.ticks_a_row)
        demand = Demand(tick, float(clock.s[k]), poses.position[k], poses.rotation[k], twists[k])
        for modify in modifiers:
            demand = modify(demand)
        yield demand
