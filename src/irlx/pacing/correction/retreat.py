"""How an offset goes back to where the next motion has room for it, the plan standing."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.correction.offset_limiter import OffsetLimiter
from irlx.pacing.correction.plan import PlannedRow
from irlx.robot.limits import JointLimits
from irlx.transform.precision import BOUND_RESERVE
from irlx.transform.step_bounds import braking_speed

Array = NDArray[np.float64]

UNKNOWN_SPEED = 0.5
"""Most speed (rad/s or m/s) of a joint without a speed limit."""

UNKNOWN_ACCELERATION = 2.0
"""Most acceleration (rad/s2 or m/s2) of a joint without an acceleration limit."""


AT_GOAL = 1e-12
"""Distance (rad or m) of an offset from its goal that rounding may leave."""

_INSIDE = 1e-9


def retreat_goal(offset: Array, limits: JointLimits, first: PlannedRow) -> Array:
    """The offset (n,) nearest to the present one for which a motion that begins with `first` has room."""
    lower = np.minimum(limits.position_lower - first.lowest + _INSIDE, 0.0)
    upper = np.maximum(limits.position_upper - first.highest - _INSIDE, 0.0)
    return np.minimum(np.maximum(offset, lower), upper)


def retreat_step(offset: Array, speed: Array, goal: Array, limiter: OffsetLimiter) -> Array:
    """Step (n,) of an offset at a speed (n,) towards a goal (n,), each joint by itself, no overshoot."""
    dt, limits, keep = limiter.dt, limiter.limits, 1.0 - BOUND_RESERVE
    fastest = keep * np.minimum(np.minimum(limits.speed_upper, -limits.speed_lower), UNKNOWN_SPEED)
    able = np.minimum(limits.acceleration_upper, -limits.acceleration_lower)
    able = keep * np.minimum(able, UNKNOWN_ACCELERATION)
    away = goal - offset
    room = np.abs(away)
    wanted = np.sign(away) * np.minimum(fastest, braking_speed(room, able, dt))
    step = dt * np.clip(wanted, speed - able * dt, speed + able * dt)
    return np.asarray(np.where(room <= np.abs(step) * (1.0 + 1e-9), away, step))
