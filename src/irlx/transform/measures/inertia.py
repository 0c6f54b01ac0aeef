"""The inertia matrix of a robot, and how it changes with the joints."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from irlx.robot.description import RobotDescription
from irlx.robot.kinematics import Kinematics
from irlx.transform.measures.jacobian_derivative import jacobian_derivative
from irlx.transform.measures.measure import Array


def has_masses(description: RobotDescription) -> bool:
    """Whether any link that the robot's axes move has a mass; without one, dynamic measures mean nothing."""
    return any(inertia.mass > 0.0 for inertia in Kinematics(description).model.inertias.tolist()[1:])


def inertia_matrix(kinematics: Kinematics, q: Array) -> Array:
    """M(q), shape (n, n), symmetric: kg m2 of two turning joints, kg m of one, kg of two sliding ones.

    The kinetic energy at the joint speeds v is 1/2 v' M v, in J.
    """
    found = np.array(pin.crba(kinematics.model, kinematics.data, kinematics.expanded(q)))
    return (
        found
        if kinematics.coupling is None
        else np.asarray(kinematics.coupling.T @ found @ kinematics.coupling)
    )


def inertia_derivative(kinematics: Kinematics, q: Array) -> Array:
    """Derivative of M(q) by q, shape (n, n, n), joint of q last: units of M per rad or m.

    With S_i the axis of joint i as a twist in the world, Y_i the inertia of all links from joint i on, and
    the earlier joints thought to move against the world instead of the later ones,
    dM_ik / dq_j = <[S_i, S_j], Y_max(j, k) S_k> for i before j, plus the same with i and k exchanged.
    """
    model, data = kinematics.model, kinematics.data
    pin.crba(model, data, kinematics.expanded(q), pin.Convention.WORLD)
    axes = np.array(data.J)
    inertias = np.array([inertia.matrix() for inertia in data.oYcrb.tolist()[1:]])
    momenta = inertias @ axes
    own = np.einsum("kck->ck", momenta)
    joints = np.arange(model.nv)
    momenta = np.where(joints[:, None, None] < joints, own, momenta)
    half = jacobian_derivative(axes).transpose(2, 1, 0) @ momenta
    found = (half + half.transpose(0, 2, 1)).transpose(1, 2, 0)
    if kinematics.coupling is not None:
        a = kinematics.coupling
        found = np.einsum("ijk,ia,jb,kc->abc", found, a, a, a)
    return np.asarray(found)
