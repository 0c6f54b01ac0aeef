"""How far each joint may step in a tick: position, speed, acceleration and braking room together.

All bounds count from the start of the tick (TRF-02); counted per Newton iteration they would let a
tick of several iterations pass its speed limit.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from irlx.robot.limits import JointLimits
from irlx.transform.precision import BOUND_RESERVE, EMPTY_INTERVAL

Array = NDArray[np.float64]
Sources = NDArray[np.int8]

_MARGIN = 1.001


class BoundSource(IntEnum):
    """Which limit a bound of a step comes from."""

    POSITION = 0
    SPEED = 1
    ACCELERATION = 2
    BRAKING = 3


def braking_speed(room: Array, deceleration: Array, dt: float | Array) -> Array:
    """Fastest speed from which whole ticks of `deceleration` stop within `room`.

    With steps v dt, (v - a dt) dt, ... down to rest: v = a dt (u / (m + 1) + m / 2), u = room / (a dt^2),
    m = floor((sqrt(1 + 8 u) - 1) / 2). Shapes (n,), or (N, n) with ticks `dt` (N, 1); room in rad or m, not
    negative; infinite where `deceleration` or `room` is.
    """
    plain = (deceleration > 0.0) & (deceleration < np.inf)
    if np.count_nonzero(plain) == plain.size and np.count_nonzero(room < np.inf) == room.size:
        # The formula as it stands: most robots know all accelerations.
        return _stopping(room, deceleration * dt, deceleration * dt**2)
    speed = np.full(room.shape, np.inf)
    known = np.isfinite(deceleration) & np.isfinite(room)
    a = np.broadcast_to(deceleration, room.shape)[known]
    dt = np.broadcast_to(dt, room.shape)[known]
    unit = a * dt**2
    # A joint that cannot decelerate at all must not move towards its limit.
    u = np.divide(np.maximum(room[known], 0.0), unit, out=np.zeros_like(unit), where=unit > 0.0)
    m = np.floor((np.sqrt(1.0 + 8.0 * u) - 1.0) / 2.0)
    speed[known] = a * dt * (u / (m + 1.0) + m / 2.0)
    return speed


class StepBounds:
    """Interval ``[lower, upper]`` of the whole step of a tick for each joint, shape (n,), rad or m.

    `lower_source` and `upper_source` hold the `BoundSource` of each side. Most ticks ask for neither:
    `find_sources` may be given in their place and is called when they are first read.
    """

    __slots__ = ("_find_sources", "_sources", "lower", "upper")

    def __init__(
        self,
        lower: Array,
        upper: Array,
        lower_source: Sources | None = None,
        upper_source: Sources | None = None,
        find_sources: Callable[[], StepBounds] | None = None,
    ) -> None:
        self.lower = lower
        self.upper = upper
        self._find_sources = find_sources
        self._sources: tuple[Sources, Sources] | None = None
        if lower_source is not None and upper_source is not None:
            self._sources = lower_source, upper_source

    @property
    def lower_source(self) -> Sources:
        """`BoundSource` of each lower bound, shape (n,)."""
        return self._both_sources()[0]

    @property
    def upper_source(self) -> Sources:
        """`BoundSource` of each upper bound, shape (n,)."""
        return self._both_sources()[1]

    def _both_sources(self) -> tuple[Sources, Sources]:
        if self._sources is None:
            if self._find_sources is None:
                raise ValueError("bounds of a step need their sources, or a way to find them")
            found = self._find_sources()
            self._sources = found.lower_source, found.upper_source
        return self._sources

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
        # Speed that one tick adds at most; infinite where no acceleration is known.
        self._gain_lower = dt * self._acceleration_lower
        self._gain_upper = dt * self._acceleration_upper
        self._brake_upper = _Brake(-self._acceleration_lower, dt)
        self._brake_lower = _Brake(self._acceleration_upper, dt)
        needed = _room_for(self._speed_upper, -self._acceleration_lower, dt)
        self._roomy_upper = _inside(limits.position_upper, needed)
        needed = _room_for(-self._speed_lower, self._acceleration_upper, dt)
        self._roomy_lower = -_inside(-limits.position_lower, needed)

    def bounds(self, q: Array, speed: Array) -> StepBounds:
        """Bounds of the step from posture q, shape (n,), reached at joint `speed` (per s).

        The sources are found when they are asked for.
        """
        lower, upper = self._speed_lower, self._speed_upper
        # Joints that can stop from their full speed need neither their room nor their braking room.
        if np.count_nonzero(q >= self._roomy_lower) < q.size:
            room = self.limits.position_lower - q
            lower = np.maximum(lower, room)
            if self._accelerations_known:
                lower = np.maximum(lower, -self.dt * self._brake_lower.speed(-room))
        if np.count_nonzero(q <= self._roomy_upper) < q.size:
            room = self.limits.position_upper - q
            upper = np.minimum(upper, room)
            if self._accelerations_known:
                upper = np.minimum(upper, self.dt * self._brake_upper.speed(room))
        if self._accelerations_known:
            lower = np.maximum(lower, self.dt * (speed + self._gain_lower))
            upper = np.minimum(upper, self.dt * (speed + self._gain_upper))
        if np.count_nonzero(lower > upper):
            return self.bounds_with_sources(q, speed)
        return StepBounds(lower, upper, find_sources=lambda: self.bounds_with_sources(q, speed))

    def kept(self, q: Array, speed: Array, rows: Array) -> int:
        """How many of the first postures `rows` (N, n), one a tick from posture q (n,) on, keep all bounds.

        `speed` (n,) is that of the joints at q, as in `bounds`.
        """
        before = np.concatenate([q[None], rows[:-1]])
        steps = rows - before
        inside = (steps >= self._speed_lower) & (steps <= self._speed_upper)
        if self._accelerations_known:
            speeds = np.concatenate([speed[None], steps[:-1] / self.dt])
            inside &= steps >= self.dt * (speeds + self._gain_lower)
            inside &= steps <= self.dt * (speeds + self._gain_upper)
        if not (np.all(before >= self._roomy_lower) and np.all(before <= self._roomy_upper)):
            inside &= self._keep_room(before, steps, rows)
        kept = np.all(inside, axis=1)
        return len(rows) if np.all(kept) else int(np.argmin(kept))

    def _keep_room(self, before: Array, steps: Array, rows: Array) -> NDArray[np.bool_]:
        """Which steps (N, n) from postures to postures (N, n) keep positions and the room to brake."""
        limits = self.limits
        inside = (rows >= limits.position_lower) & (rows <= limits.position_upper)
        if self._accelerations_known:
            below, above = before - limits.position_lower, limits.position_upper - before
            inside &= steps >= -self.dt * self._brake_lower.speed(below)
            inside &= steps <= self.dt * self._brake_upper.speed(above)
        return inside

    def into_positions(self, q: Array) -> Array:
        """`JointLimits.into_positions` of one posture (n,)."""
        return np.minimum(np.maximum(q, self.limits.position_lower), self.limits.position_upper)

    def bounds_with_sources(self, q: Array, speed: Array) -> StepBounds:
        """The same bounds, each with the limit that it comes from; contradictions of rounding removed."""
        dt, limits = self.dt, self.limits
        uppers = [limits.position_upper - q, self._speed_upper]
        lowers = [limits.position_lower - q, self._speed_lower]
        if self._accelerations_known:
            uppers.append(dt * (speed + self._gain_upper))
            lowers.append(dt * (speed + self._gain_lower))
            uppers.append(dt * self._brake_upper.speed(uppers[0]))
            lowers.append(-dt * self._brake_lower.speed(-lowers[0]))
        return _intersect(np.array(lowers), np.array(uppers))


class _Brake:
    """`braking_speed` at decelerations (n,) and a tick that stay the same."""

    def __init__(self, deceleration: Array, dt: float) -> None:
        self._deceleration, self._dt = deceleration, dt
        # The formula as it stands needs a finite deceleration that is not zero for every joint.
        self._plain = bool(np.all(np.isfinite(deceleration) & (deceleration > 0.0)))
        self._step = deceleration * dt
        self._unit = deceleration * dt**2

    def speed(self, room: Array) -> Array:
        """Fastest speed (n,) from which whole ticks stop within `room` (n,), see `braking_speed`."""
        if not (self._plain and np.count_nonzero(room < np.inf) == room.size):
            return braking_speed(room, self._deceleration, self._dt)
        return _stopping(room, self._step, self._unit)


def _stopping(room: Array, step: Array, unit: Array) -> Array:
    """`braking_speed` for `step` a dt and `unit` a dt^2, all of them finite and above 0."""
    u = np.maximum(room, 0.0) / unit
    m = np.floor((np.sqrt(1.0 + 8.0 * u) - 1.0) / 2.0)
    return np.asarray(step * (u / (m + 1.0) + m / 2.0))


def _room_for(step: Array, deceleration: Array, dt: float) -> Array:
    """Room (n,) that is enough to brake from a speed of `step` (n,) a tick; infinite where none is.

    Whole ticks need less than v^2 / (2 a) + v dt; a little more keeps rounding out of the comparison.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        ramp = np.where(np.isfinite(deceleration), (step / dt) ** 2 / (2.0 * deceleration), 0.0)
        room = _MARGIN * (ramp + step)
    return np.where(np.isnan(room), np.inf, room)


def _inside(limit: Array, room: Array) -> Array:
    """Joint values (n,) up to which `room` is left before an upper limit, infinite where there is none."""
    return np.where(limit == np.inf, np.inf, limit - np.where(limit == np.inf, 0.0, room))


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
