"""A condition between a robot's own joints, where virtual ones stand among them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.robot.equality import Constraint

Array = NDArray[np.float64]


class VirtualConstraint(Constraint):
    """`constraint` of the joints at places `joints` (n,) of more: the others have no part in it."""

    def __init__(self, constraint: Constraint, joints: NDArray[np.int64]) -> None:
        self.name = constraint.name
        self._constraint = constraint
        self._joints = joints

    def residual(self, q: Array) -> Array:
        """Phi at the own joints, shape (k,)."""
        # Called with zeros of any number to learn how many equations there are.
        return self._constraint.residual(q[self._joints])

    def derivative(self, q: Array) -> Array:
        """Derivative by all joints, shape (k, n)."""
        own = self._constraint.derivative(q[self._joints])
        found = np.zeros((own.shape[0], q.size))
        found[:, self._joints] = own
        return found
