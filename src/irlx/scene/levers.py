"""By how much two solids come nearer at most while the joints move."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics

Array = NDArray[np.float64]
Numbers = NDArray[np.intp]


@dataclass(frozen=True)
class Levers:
    """Levers (K, n) of K pairs: what a unit of each joint moves them against each other at most, m.

    A joint that turns moves a point by its distance from the axis, at most the length of all that lies
    between: `fixed` with all slides at 0, and what slides are drawn out. A joint that carries both counts
    nothing. `slides` are the values of sliding joints, a (n,) and b of a q + b, and the levers (K, n) that a
    metre of each adds.
    """

    fixed: Array
    slides: tuple[tuple[Array, float, Array], ...]

    @classmethod
    def of(
        cls,
        kinematics: Kinematics,
        bodies: Sequence[int],
        radii: Sequence[float],
        first: Numbers,
        second: Numbers,
    ) -> Levers:
        """Levers of pairs of solids by their numbers.

        Each solid is carried by one of the joints `bodies` (0: the world) and lies within one of the `radii`
        (m) about its frame.
        """
        lengths = [float(np.linalg.norm(place.translation)) for place in kinematics.model.jointPlacements]
        axes = kinematics.description.moving
        n = len(axes)
        fixed = np.zeros((len(bodies), n))
        drawn = {k: np.zeros((len(bodies), n)) for k, axis in enumerate(axes) if axis.is_prismatic}
        for solid, (body, radius) in enumerate(zip(bodies, radii, strict=True)):
            way = radius
            for joint in range(body - 1, -1, -1):
                fixed[solid, joint] = 1.0 if axes[joint].is_prismatic else way
                way += lengths[joint + 1]
            for slide, added in drawn.items():
                turning = [joint for joint in range(min(slide, body)) if not axes[joint].is_prismatic]
                added[solid, turning] = float(slide < body)
        # What carries both moves neither against the other.
        index, carriers = np.arange(n), np.array(bodies, dtype=np.intp)
        apart = index >= np.minimum(carriers[first], carriers[second])[:, None]
        by_axes = _sizes_by_axes(kinematics)
        pairs = (apart * (fixed[first] + fixed[second])) @ by_axes
        values, offsets = (
            kinematics.expanded(np.eye(kinematics.joints)),
            kinematics.expanded(np.zeros(kinematics.joints)),
        )
        slides = (
            (values[:, k] - offsets[k], float(offsets[k]), (apart * (added[first] + added[second])) @ by_axes)
            for k, added in drawn.items()
        )
        return cls(pairs, tuple(slides))

    @property
    def longest(self) -> Array | None:
        """The longest lever of each joint (n,) over all pairs; None where slides make them longer."""
        return None if self.slides else np.max(self.fixed, axis=0, initial=0.0)

    def moved(self, before: Array, after: Array) -> Array:
        """Bound (K,), m, of what pairs come nearer between two postures (n,), every joint going straight.

        Of many postures at once, either of them (N, n), the bounds are (N, K).
        """
        way = np.abs(after - before)
        bound = way @ self.fixed.T
        for value, offset, added in self.slides:
            ends = np.abs(before @ value + offset), np.abs(after @ value + offset)
            bound = bound + np.maximum(*ends)[..., None] * (way @ added.T)
        return np.asarray(bound)


def _sizes_by_axes(kinematics: Kinematics) -> Array:
    """By how much each moving joint moves at most with each axis, (N, n)."""
    return np.abs(kinematics.by_axes(np.eye(kinematics.model.nv)))
