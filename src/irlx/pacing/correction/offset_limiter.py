"""How far the joints may step off the planned rows in a tick."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.robot.limits import JointLimits
from irlx.transform.precision import EMPTY_INTERVAL
from irlx.transform.step_bounds import BoundSource, StepBounds, StepLimiter

Array = NDArray[np.float64]
_GUARDS = (BoundSource.POSITION, BoundSource.BRAKING)


class OffsetLimiter:
    """Bounds of the step of the offset (n,) that a correction adds to planned postures.

    `limits`: speeds and accelerations of corrections, positions of the joints themselves. As long as every
    step stays inside, the offset can be braked to rest while the plan goes on, and positions are kept.
    """

    def __init__(self, limits: JointLimits, dt: float) -> None:
        self.limits = limits
        self.dt = dt
        self._limiter = StepLimiter(limits, dt)

    def bounds(self, offset: Array, speed: Array, lowest: Array, highest: Array) -> StepBounds:
        """Bounds for an offset at a speed (n,); `lowest`, `highest` (n,): what the plan still reaches."""
        above = self._limiter.bounds(highest + offset, speed)
        if np.array_equal(lowest, highest):
            return above
        below = self._limiter.bounds(lowest + offset, speed)
        lower, upper = below.lower, above.upper
        touching = (lower > upper) & (lower - upper <= EMPTY_INTERVAL)
        if np.any(touching):
            # Both calls settled what rounding leaves between two bounds, each without the other.
            guards = np.isin(above.upper_source, _GUARDS)
            lower, upper = (
                np.where(touching & guards, upper, lower),
                np.where(touching & ~guards, lower, upper),
            )

        def sources() -> StepBounds:
            return StepBounds(lower, upper, below.lower_source, above.upper_source)

        return StepBounds(lower, upper, find_sources=sources)

    def braked(self, speed: Array, bounds: StepBounds) -> Array:
        """Step (n,) of an offset at a speed (n,) that brakes as hard as it may."""
        slowest = np.where(speed > 0.0, np.maximum(bounds.lower, 0.0), np.minimum(bounds.upper, 0.0))
        # A bound may ask for a step where the offset would rest.
        return np.minimum(np.maximum(np.where(speed == 0.0, 0.0, slowest), bounds.lower), bounds.upper)
