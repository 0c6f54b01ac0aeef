"""The kinematic model of a robot: tool pose, pose difference and Jacobian, by Pinocchio."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from irlx.robot.description import Inertial, Joint, JointKind, RobotDescription

Array = NDArray[np.float64]

_LOCAL = pin.ReferenceFrame.LOCAL
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


def _joint_model(joint: Joint) -> Any:
    """Pinocchio's joint; continuous joints turn about a plain angle so that nq = nv = n."""
    kind = JointKind.REVOLUTE if joint.kind is JointKind.CONTINUOUS else joint.kind
    aligned = _ALIGNED.get((kind, joint.axis))
    if aligned is not None:
        return aligned()
    model = (
        pin.JointModelPrismaticUnaligned if kind is JointKind.PRISMATIC else pin.JointModelRevoluteUnaligned
    )
    return model(np.array(joint.axis))


def _displacement(joint: Joint, value: float) -> pin.SE3:
    """Motion of a joint frame that stands at `value` (rad or m)."""
    if joint.kind is JointKind.FIXED:
        return pin.SE3.Identity()
    axis = np.array(joint.axis)
    if joint.is_prismatic:
        return pin.SE3(np.eye(3), axis * value)
    return pin.SE3(pin.exp3(axis * value), np.zeros(3))


def _inertia(inertial: Inertial) -> pin.Inertia:
    ixx, ixy, ixz, iyy, iyz, izz = inertial.inertia
    matrix = np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
    about_centre = pin.Inertia(inertial.mass, np.zeros(3), matrix)
    return placement(inertial.xyz, inertial.rpy).act(about_centre)


class Kinematics:
    """Forward kinematics and Jacobian of the tool frame of one robot.

    Joint vectors q have shape (n,), rad or m, in the order of `RobotDescription.axes`. Twists are
    (linear m, angular rad) in the tool frame. Not safe for use by several threads at once: results
    of one call are kept in buffers of the object.
    """

    def __init__(self, description: RobotDescription) -> None:
        self.description = description
        self.model = pin.Model()
        self.model.name = description.name
        self._axis_names = set(description.joint_names)
        self._children: dict[str, list[Joint]] = {}
        for joint in description.joints:
            self._children.setdefault(joint.parent, []).append(joint)
        self._tip_frame = -1
        self._add_link(description.root, 0, pin.SE3.Identity())
        self.data = self.model.createData()
        self.joints = len(description.axes)

    def _add_link(self, link: str, parent: int, in_parent: pin.SE3) -> None:
        """Add a link, welded to Pinocchio joint `parent` at `in_parent`, and all that hangs on it."""
        inertial = self.description.inertials.get(link)
        if inertial is not None:
            # Many published URDFs have inertias that no body has; nothing here moves by them.
            with suppress(RuntimeError, ValueError):
                self.model.appendBodyToJoint(parent, _inertia(inertial), in_parent)
        if link == self.description.tip:
            frame = pin.Frame(link, parent, 0, in_parent, pin.FrameType.OP_FRAME)
            self._tip_frame = self.model.addFrame(frame)
        for joint in self._children.get(link, []):
            origin = in_parent * placement(joint.xyz, joint.rpy)
            if joint.name in self._axis_names:
                index = self.model.addJoint(parent, _joint_model(joint), origin, joint.name)
                self._add_link(joint.child, index, pin.SE3.Identity())
            else:
                held_at = self.description.locked.get(joint.name, 0.0)
                self._add_link(joint.child, parent, origin * _displacement(joint, held_at))

    def tool_pose(self, q: Array) -> tuple[Array, Array]:
        """Rotation (3, 3) and position (3,) m of the tool frame in the world."""
        pin.forwardKinematics(self.model, self.data, q)
        pose = pin.updateFramePlacement(self.model, self.data, self._tip_frame)
        return pose.rotation.copy(), pose.translation.copy()

    def tool_poses(self, q: Array) -> tuple[Array, Array]:
        """Rotations (N, 3, 3) and positions (N, 3) m of the tool frame at the postures q (N, n)."""
        rotation, position = np.empty((len(q), 3, 3)), np.empty((len(q), 3))
        model, data, tip = self.model, self.data, self._tip_frame
        for k, row in enumerate(q):
            pin.forwardKinematics(model, data, row)
            pose = pin.updateFramePlacement(model, data, tip)
            rotation[k], position[k] = pose.rotation, pose.translation
        return rotation, position

    def difference(self, q: Array, target: pin.SE3) -> tuple[Array, Array]:
        """Twist that leads the tool from its pose at q to `target`, and the Jacobian of the tool.

        Returns log6(T(q)^-1 T_target), shape (6,), and J(q), shape (6, n), both in the tool frame:
        a joint step d moves the tool by the twist J d to first order.
        """
        pin.computeJointJacobians(self.model, self.data, q)
        pose = pin.updateFramePlacement(self.model, self.data, self._tip_frame)
        twist = pin.log6(pose.actInv(target)).vector
        jacobian = pin.getFrameJacobian(self.model, self.data, self._tip_frame, _LOCAL)
        return twist, jacobian

    def difference_derivative(self, q: Array, target: pin.SE3) -> tuple[Array, Array]:
        """The twist of `difference` and its exact derivative by q, shape (6, n), also far from the target.

        With E = T(q)^-1 T_target a step d turns E into exp(-J d) E, so d log6(E) = -Jlog6(E) Ad(E^-1) J d.
        """
        twist, jacobian = self.difference(q, target)
        apart = self.data.oMf[self._tip_frame].actInv(target)
        return twist, -pin.Jlog6(apart) @ apart.inverse().action @ jacobian

    def target(self, rotation: Array, position: Array) -> pin.SE3:
        """Pose of rotation (3, 3) and position (3,) m as Pinocchio keeps it."""
        return pin.SE3(rotation, position)
