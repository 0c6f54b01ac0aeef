"""Which conditions of a cell joints that are not frozen can still break: the others hold as they stand."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from irlx.robot.description import RobotDescription
from irlx.robot.equality import Constraint

Array = NDArray[np.float64]

_POSTURES, _SEED = 4, 7


class SomeRows(Constraint):
    """Those equations of a constraint that joints can break, the others left out."""

    def __init__(self, constraint: Constraint, kept: NDArray[np.bool_]) -> None:
        self.name = constraint.name
        self._constraint = constraint
        self._kept = kept

    def residual(self, q: Array) -> Array:
        """Phi at posture q (n,) in the rows kept."""
        return self._constraint.residual(q)[self._kept]

    def derivative(self, q: Array) -> Array:
        """Its derivative by q."""
        return self._constraint.derivative(q)[self._kept]

    def rows(self, q: Array) -> tuple[Array, Array]:
        """Both at once."""
        left, derivative = self._constraint.rows(q)
        return left[self._kept], derivative[self._kept]


def moved_constraints(
    constraints: Sequence[Constraint], robot: RobotDescription, q: Array, free: NDArray[np.bool_]
) -> tuple[Constraint, ...]:
    """The constraints, without equations that no `free` joint (n,) moves while the others stay as in q (n,).

    An equation that rests is as good as it was, and nobody could better it. Left in, its row of zeros would
    make every posture singular.
    """
    if np.all(free):
        return tuple(constraints)
    wide = np.array([robot.reach if axis.is_prismatic else 1.0 for axis in robot.axes]) * free
    rng = np.random.default_rng(_SEED)
    postures = q + wide * rng.uniform(-1.0, 1.0, (_POSTURES, q.size))
    found: list[Constraint] = []
    for constraint in constraints:
        moves = constraint.breakable(postures, free)
        if np.all(moves):
            found.append(constraint)
        elif np.any(moves):
            found.append(SomeRows(constraint, moves))
    return tuple(found)
