"""What Pinocchio makes of the joints, origins and inertias of a description."""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio as pin

from irlx.robot.description import Inertial, Joint, JointKind

_ALIGNED = {
    (JointKind.REVOLUTE, (1.0, 0.0, 0.0)): pin.JointModelRX,
    (JointKind.REVOLUTE, (0.0, 1.0, 0.0)): pin.JointModelRY,
    (JointKind.REVOLUTE, (0.0, 0.0, 1.0)): pin.JointModelRZ,
    (JointKind.PRISMATIC, (1.0, 0.0, 0.0)): pin.JointModelPX,
    (JointKind.PRISMATIC, (0.0, 1.0, 0.0)): pin.JointModelPY,
    (JointKind.PRISMATIC, (0.0, 0.0, 1.0)): pin.JointModelPZ,
}


def placement(xyz: tuple[float, float, float], rpy: tuple[float, float, float]) -> pin.SE3:
    """SE3 of an origin: translation m, rotations about the fixed x, y, z axes, rad."""
    return pin.SE3(pin.rpy.rpyToMatrix(*rpy), np.array(xyz))


def joint_model(joint: Joint) -> Any:
    """Pinocchio's joint; continuous joints turn about a plain angle so that nq = nv = n."""
    kind = JointKind.REVOLUTE if joint.kind is JointKind.CONTINUOUS else joint.kind
    aligned = _ALIGNED.get((kind, joint.axis))
    if aligned is not None:
        return aligned()
    model = (
        pin.JointModelPrismaticUnaligned if kind is JointKind.PRISMATIC else pin.JointModelRevoluteUnaligned
    )
    return model(np.array(joint.axis))


def displacement(joint: Joint, value: float) -> pin.SE3:
    """Motion of a joint frame that stands at `value` (rad or m)."""
    if joint.kind is JointKind.FIXED:
        return pin.SE3.Identity()
    axis = np.array(joint.axis)
    if joint.is_prismatic:
        return pin.SE3(np.eye(3), axis * value)
    return pin.SE3(pin.exp3(axis * value), np.zeros(3))


def inertia_of(inertial: Inertial) -> pin.Inertia:
    """Inertia of a link in its own frame."""
    ixx, ixy, ixz, iyy, iyz, izz = inertial.inertia
    matrix = np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
    about_centre = pin.Inertia(inertial.mass, np.zeros(3), matrix)
    return placement(inertial.xyz, inertial.rpy).act(about_centre)
