"""How freely the drives can accelerate the tool in all directions."""

from __future__ import annotations

import numpy as np

from irlx.robot.kinematics import Kinematics
from irlx.transform.measures.ellipsoid import volume, volume_derivative
from irlx.transform.measures.inertia import inertia_derivative, inertia_matrix
from irlx.transform.measures.measure import Array, Measure
from irlx.transform.measures.scaled_jacobian import task_jacobian, task_jacobian_derivative

_NO_INERTIA = 1e-14
"""Ratio of the smallest to the largest eigenvalue of the inertia matrix that is rounding alone."""


class DynamicManipulability(Measure):
    """w = sqrt(det(J M^-1 M^-T J')) (Yoshikawa 1985): J as for `Manipulability`, M (n, n) the inertia matrix.

    J M^-1 (6, n) leads from drive forces (Nm or N) to the acceleration of the tool (rad/s2; position rows
    in reaches/s2). With fewer than six joints w is the product of its n singular values. At singular
    postures w is 0 and its gradient, for the same reason as that of `Manipulability`, too.
    """

    name = "dynamic manipulability"
    sense = -1

    def __init__(self, kinematics: Kinematics) -> None:
        """Measure of a robot; raises ValueError where its masses leave a joint without inertia."""
        self.kinematics = kinematics
        # The rank of M at a posture with nothing special about it is its rank almost everywhere.
        anywhere: Array = 0.4 + 0.3 * np.arange(float(kinematics.joints))
        values, vectors = np.linalg.eigh(inertia_matrix(kinematics, anywhere))
        if values[0] <= _NO_INERTIA * values[-1]:
            joint = kinematics.description.joint_names[int(np.argmax(np.abs(vectors[:, 0])))]
            raise ValueError(f"the masses of '{kinematics.description.name}' leave '{joint}' without inertia")

    def _mobility(self, q: Array) -> Array:
        """M^-1."""
        return np.asarray(np.linalg.inv(inertia_matrix(self.kinematics, q)), dtype=np.float64)

    def value(self, q: Array) -> float:
        """w."""
        return volume(task_jacobian(self.kinematics, q) @ self._mobility(q))

    def gradient(self, q: Array) -> Array:
        """Derivative of w by q, shape (n,).

        dw = <G, dJ M^-1 - J M^-1 dM M^-1>, G the derivative of w by the entries of J M^-1.
        """
        jacobian, moved = task_jacobian_derivative(self.kinematics, q)
        mobility = self._mobility(q)
        response = jacobian @ mobility
        by_jacobian = volume_derivative(response) @ mobility
        by_inertia = response.T @ by_jacobian
        turned = by_jacobian.ravel() @ moved.reshape(by_jacobian.size, -1)
        changed = by_inertia.ravel() @ inertia_derivative(self.kinematics, q).reshape(by_inertia.size, -1)
        return np.asarray(turned - changed)
