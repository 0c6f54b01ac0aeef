"""What the drives have to hold against gravity."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from irlx.robot.kinematics import Kinematics
from irlx.transform.measures.measure import Array, Measure


class GravityTorque(Measure):
    """1/2 tau' W tau, tau (n,) the drive forces (Nm or N) that hold the posture; W = diag(weights).

    Gravity is 9.81 m/s2 along -z of the world, the frame of the robot's root. Without weights W is the unit
    matrix; with 1 / (largest force)^2 each the measure has no unit and joints of both kinds compare.
    """

    name = "gravity torque"
    sense = 1

    def __init__(self, kinematics: Kinematics, weights: Array | None = None) -> None:
        """Measure of a robot; raises ValueError where there is not one weight >= 0 for each joint."""
        self.kinematics = kinematics
        self.weights = np.ones(kinematics.joints) if weights is None else weights
        if self.weights.shape != (kinematics.joints,) or not np.all(self.weights >= 0.0):
            raise ValueError("gravity torque takes one weight of at least 0 for each joint")

    def value(self, q: Array) -> float:
        """1/2 tau' W tau."""
        torque = pin.computeGeneralizedGravity(self.kinematics.model, self.kinematics.data, q)
        return float(0.5 * (self.weights * torque) @ torque)

    def gradient(self, q: Array) -> Array:
        """(d tau / dq)' W tau, shape (n,)."""
        model, data = self.kinematics.model, self.kinematics.data
        torque = self.weights * pin.computeGeneralizedGravity(model, data, q)
        return np.asarray(torque @ pin.computeGeneralizedGravityDerivatives(model, data, q))
