"""What the drives have to hold against gravity."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from irlx.robot.kinematics import Kinematics
from irlx.transform.measures.measure import Array, Measure


def gravity_torque(kinematics: Kinematics, q: Array) -> Array:
    """Drive forces (n,), Nm or N, that hold a posture against gravity; a drive also holds what follows it."""
    model, data = kinematics.model, kinematics.data
    return kinematics.by_axes(np.asarray(pin.computeGeneralizedGravity(model, data, kinematics.expanded(q))))


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
        torque = gravity_torque(self.kinematics, q)
        return float(0.5 * (self.weights * torque) @ torque)

    def gradient(self, q: Array) -> Array:
        """(d tau / dq)' W tau, shape (n,)."""
        kinematics = self.kinematics
        torque = self.weights * gravity_torque(kinematics, q)
        slope = pin.computeGeneralizedGravityDerivatives(
            kinematics.model, kinematics.data, kinematics.expanded(q)
        )
        return np.asarray(torque @ kinematics.by_axes(kinematics.by_axes(slope.T).T))
