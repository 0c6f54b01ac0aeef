"""Bounds of the joints: position, speed and acceleration, each with a lower and an upper side."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class JointLimits:
    """Bounds of n joints as arrays of shape (n,); infinite where a joint has none.

    Positions in rad or m, speeds per s, accelerations per s2. Speed and acceleration bounds contain
    zero.
    """

    position_lower: Array
    position_upper: Array
    speed_lower: Array
    speed_upper: Array
    acceleration_lower: Array
    acceleration_upper: Array

    @classmethod
    def unlimited(cls, joints: int) -> JointLimits:
        """Limits of a robot that has none."""
        infinite = np.full(joints, np.inf)
        return cls(-infinite, infinite, -infinite, infinite, -infinite, infinite)

    def with_pair(self, kind: str, lower: Array, upper: Array) -> JointLimits:
        """Same limits with the pair of `kind` ('position', 'speed', 'acceleration') replaced."""
        return replace(self, **{f"{kind}_lower": lower, f"{kind}_upper": upper})

    def of(self, joints: NDArray[np.bool_] | NDArray[np.int64]) -> JointLimits:
        """Limits of some of the joints, chosen by a mask (n,) or by their numbers from 0."""
        return JointLimits(**{name: getattr(self, name)[joints] for name in self.__dataclass_fields__})

    def into_positions(self, q: Array) -> Array:
        """Joint values (..., n) moved onto the position limit they pass; for what rounding may have left."""
        return np.clip(q, self.position_lower, self.position_upper)

    def pair(self, kind: str) -> tuple[Array, Array]:
        """Lower and upper bounds of `kind`: 'position', 'speed' or 'acceleration'."""
        return getattr(self, f"{kind}_lower"), getattr(self, f"{kind}_upper")


def alike(first: JointLimits, second: JointLimits) -> bool:
    """Whether two sets of limits are the same, bit by bit."""
    return first is second or all(
        np.array_equal(getattr(first, name), getattr(second, name))
        for name in JointLimits.__dataclass_fields__
    )
