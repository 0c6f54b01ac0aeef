"""How freely the tool can move in its worst direction."""

from __future__ import annotations

import numpy as np

from irlx.robot.kinematics import Kinematics
from irlx.transform.measures.ellipsoid import SINGULAR
from irlx.transform.measures.measure import Array, Measure
from irlx.transform.measures.scaled_jacobian import task_jacobian, task_jacobian_derivative

CLUSTER = 1e-8
"""Difference, as a part of the largest, up to which singular values count as one multiple value."""


class SmallestSingularValue(Measure):
    """Smallest singular value of J (6, n), the tool Jacobian with its position rows divided by the reach.

    Its gradient is u' (dJ/dq_j) v with the singular vectors u, v. Two kinds of postures have none:
    - The smallest value is multiple. Given is the gradient of the mean of the values that agree with it: it
      is one of the generalised gradients (Clarke), does not depend on the singular vectors chosen, and for a
      double value it is the limit of the central difference.
    - The posture is singular. The value 0 rises alike in opposite directions, and the gradient given is 0.
    """

    name = "smallest singular value"
    sense = -1

    def __init__(self, kinematics: Kinematics) -> None:
        self.kinematics = kinematics

    def value(self, q: Array) -> float:
        """The smallest of the min(6, n) singular values; 0 at a singular posture."""
        singular = np.linalg.svd(task_jacobian(self.kinematics, q), compute_uv=False)
        return float(singular[-1]) if singular[-1] > SINGULAR * singular[0] else 0.0

    def gradient(self, q: Array) -> Array:
        """u' (dJ/dq_j) v for each joint j, the mean over a multiple smallest value, shape (n,)."""
        jacobian, changed = task_jacobian_derivative(self.kinematics, q)
        left, singular, right = np.linalg.svd(jacobian, full_matrices=False)
        if singular[-1] <= SINGULAR * singular[0]:
            return np.zeros(q.size)
        first = int(np.argmax(singular - singular[-1] <= CLUSTER * singular[0]))
        by_entries = (left[:, first:] @ right[first:]).ravel() / (singular.size - first)
        return np.asarray(by_entries @ changed.reshape(by_entries.size, -1))
