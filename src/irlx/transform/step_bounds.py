"""How far each joint may step in a tick: position, speed, acceleration and braking room together.

All bounds count from the start of the tick (TRF-02); counted per Newton iteration they would let a
tick of several iterations pass its speed limit.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from irlx.robot.limits import JointLimits
from irlx.transform.precision import BOUND_RESERVE, EMPTY_INTERVAL

Array = NDArray[np.float64]


class BoundSource(IntEnum):
    """Which limit a bound of a step comes from."""

    POSITION = 0
    SPEED = 1
    ACCELERATION = 2
    BRAKING = 3


def braking_speed(room: Array, deceleration: Array, dt: float) -> Array:
    """Fastest speed from which whole ticks of `deceleration` stop within `room`.

    With steps v dt, (v - a dt) dt, ... down to rest: v = a dt (u / (m + 1) + m / 2), u = room / (a dt^2),
    m = floor((sqrt(1 + 8 u) - 1) / 2). Shapes (n,); room in rad or m, not negative; infinite where
    `deceleration` or `room` is.
    """
    speed = np.full(room.shape, np.inf)
    known = np.isfinite(deceleration) & np.isfinite(room)
    a = deceleration[known]
    unit = a * dt**2
    # A joint that cannot decelerate at all must not move towards its limit.
    u = np.divide(np.maximum(room[known], 0.0), unit, out=np.zeros_like(unit), where=unit > 0.0)
    m = np.floor((np.sqrt(1.0 + 8.0 * u) - 1.0) / 2.0)
    speed[known] = a * dt * (u / (m + 1.0) + m / 2.0)
    return speed


@dataclass(frozen=True)
class StepBounds:
    """Interval ``[lower, upper]`` of the whole step of a tick for each joint, shape (n,), rad or m.

    `lower_source` and `upper_source` hold the `BoundSource` of each side.
    """

    lower: Array
    upper: Array
    lower_source: NDArray[np.int8]
    upper_source: NDArray[np.int8]

    @property
    def conflicts(self) -> NDArray[np.intp]:
        """Joints whose bounds contradict each other."""
        return np.flatnonzero(self.lower > self.upper)


class StepLimiter:
    """Bounds of the step of one tick after another, for limits that stay the same over a motion."""

    def __init__(self, limits: JointLimits, dt: float, reserve: float = BOUND_RESERVE) -> None:
        self.limits = limits
        self.dt = dt
        keep = 1.0 - reserve
        self._speed_lower = dt * limits.speed_lower * keep
        self._speed_upper = dt * limits.speed_upper * keep
        self._acceleration_lower = limits.acceleration_lower * keep
        self._acceleration_upper = limits.acceleration_upper * keep
        both = np.isfinite(self._acceleration_lower) | np.isfinite(self._acceleration_upper)
        self._accelerations_known = bool(np.any(both))

    def bounds(self, q: Array, speed: Array) -> StepBounds:
        """Bounds of the step from posture q, shape (n,), reached at joint `speed` (per s)."""
        dt, limits = self.dt, self.limits
        uppers = [limits.position_upper - q, self._speed_upper]
        lowers = [limits.position_lower - q, self._speed_lower]
        if self._accelerations_known:
            uppers.append(dt * (speed + dt * self._acceleration_upper))
            lowers.append(dt * (speed + dt * self._acceleration_lower))
            uppers.append(dt * braking_speed(uppers[0], -self._acceleration_lower, dt))
            lowers.append(-dt * braking_speed(-lowers[0], self._acceleration_upper, dt))
        return _intersect(np.array(lowers), np.array(uppers))


def _intersect(lowers: Array, uppers: Array) -> StepBounds:
    lower_source = np.argmax(lowers, axis=0).astype(np.int8)
    upper_source = np.argmin(uppers, axis=0).astype(np.int8)
    joints = np.arange(lowers.shape[1])
    lower, upper = lowers[lower_source, joints], uppers[upper_source, joints]
    touching = (lower > upper) & (lower - upper <= EMPTY_INTERVAL)
    if np.any(touching):
        # Braking room and acceleration meet exactly when a joint brakes at its hardest. The side that
        # guards the position limit stays: given way there, the next tick would find less room than it needs.
        guards_limit = (lower_source == BoundSource.POSITION) | (lower_source == BoundSource.BRAKING)
        upper = np.where(touching & guards_limit, lower, upper)
        lower = np.where(touching & ~guards_limit, upper, lower)
    return StepBounds(lower, upper, lower_source, upper_source)
