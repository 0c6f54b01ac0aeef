"""How freely the tool can move in all directions."""

from __future__ import annotations

import numpy as np

from irlx.robot.kinematics import Kinematics
from irlx.transform.measures.ellipsoid import volume, volume_derivative
from irlx.transform.measures.measure import Array, Measure
from irlx.transform.measures.scaled_jacobian import task_jacobian, task_jacobian_derivative


class Manipulability(Measure):
    """w = sqrt(det(J J')) (Yoshikawa 1985), J (6, n) the tool Jacobian, position rows divided by the reach.

    The product of the singular values of J; of a robot with fewer than six joints that is sqrt(det(J' J)).
    At singular postures w is 0 and has a kink: its rise is the same in opposite directions, so none is
    better than its opposite, and the gradient given is 0.
    """

    name = "manipulability"
    sense = -1

    def __init__(self, kinematics: Kinematics) -> None:
        self.kinematics = kinematics

    def value(self, q: Array) -> float:
        """w."""
        return volume(task_jacobian(self.kinematics, q))

    def gradient(self, q: Array) -> Array:
        """w tr((J J')^-1 J dJ'/dq_j) for each joint j, shape (n,)."""
        jacobian, changed = task_jacobian_derivative(self.kinematics, q)
        by_entries = volume_derivative(jacobian).ravel()
        return np.asarray(by_entries @ changed.reshape(by_entries.size, -1))
