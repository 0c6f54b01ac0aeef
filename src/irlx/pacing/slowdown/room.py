"""How far the joints may step from one knot of a path to the next."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.slowdown.model import Model
from irlx.transform.step_bounds import BoundSource, StepBounds, braking_speed

Array = NDArray[np.float64]

_LEAD_BACK = 12.0
_TOUCHING = 1e-9


class Room(NamedTuple):
    """Bounds of one interval: position `low`, `high`; what may be stretched, `down` and `up`, all (n,).

    Of many intervals at once, where a way through is known: all (N, n), `duration` (N, 1) s.
    """

    low: Array
    high: Array
    down: Array
    up: Array
    duration: Any

    @classmethod
    def at(cls, model: Model, q: Array, bounds: tuple[Array, Array], reserve: float, duration: Any) -> Room:
        """Room from posture q (n,), or postures q (N, n), under position bounds at the next knots.

        A joint outside its bounds comes back by `reserve` / 12.
        """
        limits = model.limits
        low = np.maximum(np.minimum(bounds[0], q + reserve / _LEAD_BACK), limits.position_lower) - q
        high = np.minimum(np.maximum(bounds[1], q - reserve / _LEAD_BACK), limits.position_upper) - q
        room = np.maximum(np.concatenate([high, -low], axis=-1), 0.0)
        both = duration * np.minimum(model.speeds_either_way, braking_speed(room, model.brakes, duration))
        joints = q.shape[-1]
        return cls(low, high, both[..., joints:], both[..., :joints], duration)

    def none(self) -> StepBounds:
        """No bounds."""
        return _no_bounds(self.low.size)

    def holds(self, step: Array) -> bool:
        """Whether a step (n,) needs no stretch."""
        lower, upper = np.maximum(self.low, -self.down), np.minimum(self.high, self.up)
        return bool(((lower <= step) & (step <= upper)).all())

    def is_wide_for(self, step: Array) -> bool:
        """Whether a step (n,) needs no stretch, and touches no bound either."""
        lower, upper = np.maximum(self.low, -self.down), np.minimum(self.high, self.up)
        return bool(((lower + _TOUCHING < step) & (step < upper - _TOUCHING)).all())

    def unstretched(self) -> StepBounds:
        """All bounds as they are."""
        source = np.full(self.low.size, BoundSource.POSITION, dtype=np.int8)
        return StepBounds(np.maximum(self.low, -self.down), np.minimum(self.high, self.up), source, source)

    def positions(self) -> StepBounds:
        """Position bounds alone."""
        source = np.full(self.low.size, BoundSource.POSITION, dtype=np.int8)
        return StepBounds(self.low, self.high, source, source)

    def stretch_of(self, step: Array) -> float:
        """Stretch that a step (n,) needs."""
        bound = np.where(step > 0.0, self.up, self.down)
        share = np.abs(step) / np.maximum(bound, 1e-300)
        return max(float(np.max(np.where(np.isfinite(bound), share, 0.0))) - 1.0, 0.0)


@cache
def _no_bounds(joints: int) -> StepBounds:
    wide, source = np.full(joints, np.inf), np.full(joints, BoundSource.POSITION, dtype=np.int8)
    lower = -wide
    for array in (wide, lower, source):
        array.flags.writeable = False
    return StepBounds(lower, wide, source, source)
