"""The kinematic model of a robot: tool pose, pose difference and Jacobian, by Pinocchio."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from irlx.blocks.link_frame import LinkFrame
from irlx.robot.description import COORDINATES, Inertial, Joint, JointKind, RobotDescription
from irlx.robot.equality import Constraint
from irlx.robot.implied import implied_by_pose
from irlx.robot.task import Task, partial_difference

Array = NDArray[np.float64]

_POSTURES = 4
_STILL = 1e-9
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


class Sizes(NamedTuple):
    """What is left of a demand: a distance (m), an angle (rad), and the largest broken condition."""

    distance: float
    angle: float
    condition: float


class Kinematics:
    """Forward kinematics and Jacobian of the tool frame of one robot, and the conditions between its joints.

    The tool frame is that of the tip, or lies at the pose `tool` in it.

    Joint vectors q have shape (n,), rad or m, in the order of `RobotDescription.axes`. Twists are
    (linear m, angular rad) in the tool frame. What a tick has to meet are m rows: the coordinates of the
    robot's task, then those of the constraints. Not safe for use by several threads at once: results
    of one call are kept in buffers of the object.
    """

    def __init__(
        self,
        description: RobotDescription,
        constraints: Sequence[Constraint] = (),
        tool: pin.SE3 | None = None,
        implied: Sequence[Constraint] = (),
    ) -> None:
        """`implied` are conditions that are no rows, because the pose of the tool keeps or breaks them."""
        self.implied = tuple(implied)
        self.description = description
        self.tool = pin.SE3.Identity() if tool is None else tool
        self.constraints = tuple(constraints)
        self.task = Task(description.coordinates)
        self.model = pin.Model()
        self.model.name = description.name
        self._axis_names = set(description.joint_names)
        self._children: dict[str, list[Joint]] = {}
        for joint in description.joints:
            self._children.setdefault(joint.parent, []).append(joint)
        self._tip_frame = -1
        self._relative: dict[LinkFrame, Kinematics] = {}
        self._bodies: dict[str, tuple[int, pin.SE3]] = {}
        self._add_link(description.root, 0, pin.SE3.Identity())
        self.data = self.model.createData()
        self.joints = len(description.axes)
        self._plain = self.task.is_whole and not self.constraints
        conditions = sum(len(item.residual(np.zeros(self.joints))) for item in self.constraints)
        self.rows = self.task.size + conditions
        scale = np.ones(self.rows)
        scale[: self.task.linear] /= description.lever
        self.row_scale = scale

    def constrained(self, constraints: Sequence[Constraint]) -> Kinematics:
        """The same robot with conditions between its joints."""
        return Kinematics(self.description, constraints, self.tool)

    def with_tool(
        self, position: tuple[float, float, float], orientation: tuple[float, float, float, float]
    ) -> Kinematics:
        """The same robot with its tool frame elsewhere on the tip; conditions between its joints stay.

        `position` (m) and unit quaternion `orientation` (x, y, z, w) are those of the tool in the tip.
        """
        x, y, z, w = orientation
        turn = pin.Quaternion(w, x, y, z).normalized().toRotationMatrix()
        return Kinematics(self.description, self.constraints, pin.SE3(turn, np.array(position)))

    @property
    def frame(self) -> LinkFrame | None:
        """The frame that moves with a link in which poses of the tool are told, None for the world."""
        return None

    @cached_property
    def of_pose(self) -> Kinematics:
        """The same robot for motions that demand poses: constraints that the pose keeps or breaks by itself
        are `implied`, and no rows."""
        implied = implied_by_pose(self) if self.constraints else ()
        if not implied:
            return self
        kept = [item for item in self.constraints if item not in implied]
        return Kinematics(self.description, kept, self.tool, implied)

    @property
    def world(self) -> Kinematics:
        """The same robot, the poses of its tool told in the world."""
        return self

    def relative_to(self, frame: LinkFrame) -> Kinematics:
        """The same robot, the poses of its tool told in a frame that moves with one of its links.

        Raises KeyError where it has no such link.
        """
        found = self._relative.get(frame)
        if found is None:
            # Imported here: it is a Kinematics itself.
            from irlx.robot.relative_kinematics import RelativeKinematics

            found = self._relative[frame] = RelativeKinematics(self, frame)
        return found

    def _add_link(self, link: str, parent: int, in_parent: pin.SE3) -> None:
        """Add a link, welded to Pinocchio joint `parent` at `in_parent`, and all that hangs on it."""
        self._bodies[link] = parent, in_parent
        inertial = self.description.inertials.get(link)
        if inertial is not None:
            # Many published URDFs have inertias that no body has; nothing here moves by them.
            with suppress(RuntimeError, ValueError):
                self.model.appendBodyToJoint(parent, _inertia(inertial), in_parent)
        if link == self.description.tip:
            frame = pin.Frame(link, parent, 0, in_parent * self.tool, pin.FrameType.OP_FRAME)
            self._tip_frame = self.model.addFrame(frame)
        for joint in self._children.get(link, []):
            origin = in_parent * placement(joint.xyz, joint.rpy)
            if joint.name in self._axis_names:
                index = self.model.addJoint(parent, _joint_model(joint), origin, joint.name)
                self._add_link(joint.child, index, pin.SE3.Identity())
            else:
                held_at = self.description.locked.get(joint.name, 0.0)
                self._add_link(joint.child, parent, origin * _displacement(joint, held_at))

    def body_of(self, link: str) -> tuple[int, pin.SE3]:
        """Pinocchio joint that carries a link, 0 for the world, and the link's frame in that joint's."""
        return self._bodies[link]

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
        """What leads from posture q to a demand, and its matrix: shapes (m,) and (m, n).

        For a whole task without constraints log6(T(q)^-1 T_target) and the Jacobian of the tool, both in the
        tool frame: a joint step d moves the tool by the twist J d to first order. Else the coordinates
        of `partial_difference`, then -Phi(q) and dPhi/dq of each constraint.
        """
        if self._plain:
            return self.tool_difference(q, target)
        return self._rows(q, target, exact=False)

    def tool_difference(self, q: Array, target: pin.SE3) -> tuple[Array, Array]:
        """log6(T(q)^-1 T_target), shape (6,), and the tool Jacobian, shape (6, n), whatever the task."""
        pose, jacobian = self._pose_and_jacobian(q)
        return pin.log6(pose.actInv(target)).vector, jacobian

    def _pose_and_jacobian(self, q: Array) -> tuple[pin.SE3, Array]:
        """Pose of the tool, in a buffer, and its Jacobian (6, n) in the tool frame."""
        pin.computeJointJacobians(self.model, self.data, q)
        pose = pin.updateFramePlacement(self.model, self.data, self._tip_frame)
        return pose, pin.getFrameJacobian(self.model, self.data, self._tip_frame, _LOCAL)

    def difference_derivative(self, q: Array, target: pin.SE3) -> tuple[Array, Array]:
        """What `difference` gives first and its exact derivative by q, (m, n), also far from the target.

        With E = T(q)^-1 T_target a step d turns E into exp(-J d) E, so d log6(E) = -Jlog6(E) Ad(E^-1) J d.
        """
        left, matrix = self._rows(q, target, exact=True)
        return left, -matrix

    def _rows(self, q: Array, target: pin.SE3, exact: bool) -> tuple[Array, Array]:
        pose, matrix = self._pose_and_jacobian(q)
        if not self.task.is_whole:
            left, matrix = partial_difference(self.task, pose, matrix, target)
        else:
            apart = pose.actInv(target)
            left = pin.log6(apart).vector
            if exact:
                matrix = pin.Jlog6(apart) @ apart.inverse().action @ matrix
        if not self.constraints:
            return left, matrix
        rows = [item.rows(q) for item in self.constraints]
        residuals, derivatives = zip(*rows, strict=True)
        return np.concatenate([left, *(-one for one in residuals)]), np.concatenate([matrix, *derivatives])

    def sizes(self, left: Array) -> Sizes:
        """What is left (m,), as `difference` gives it first, in three numbers."""
        linear, size = self.task.linear, self.task.size
        condition = float(np.max(np.abs(left[size:]), initial=0.0))
        distance, angle = (float(np.linalg.norm(part)) for part in (left[:linear], left[linear:size]))
        return Sizes(distance, angle, condition)

    @property
    def row_names(self) -> tuple[str, ...]:
        """What each of the m rows is: a coordinate of the tool pose, or a constraint by its name."""
        sizes = [len(item.residual(np.zeros(self.joints))) for item in self.constraints]
        names = (
            name for item, size in zip(self.constraints, sizes, strict=True) for name in [item.name] * size
        )
        return (*self.task.coordinates, *names)

    @cached_property
    def immovable(self) -> Task:
        """Coordinates that the task leaves out and no joint moves either, as a planar arm's height."""
        moved = np.zeros(6)
        for k in range(_POSTURES):
            # Joint values without any pattern: what is zero at all of them is so everywhere.
            q = np.sin(np.arange(1.0, self.joints + 1.0) * (1.7 + k))
            jacobian = self.tool_difference(q, pin.SE3.Identity())[1]
            moved = np.maximum(moved, np.max(np.abs(jacobian), axis=1, initial=0.0))
        still = moved <= _STILL * max(1.0, self.description.reach)
        return Task(tuple(name for name in self.task.left_out if still[COORDINATES.index(name)]))

    def rows_here(self, q: Array) -> Array:
        """The matrix (m, n) of `here`."""
        if not self._plain:
            return self.here(q)[1]
        return np.asarray(self._pose_and_jacobian(q)[1])

    def here(self, q: Array) -> tuple[Array, Array]:
        """`difference` to the tool's own pose at q: constraints alone may be left."""
        return self.difference(q, self.target(*self.tool_pose(q)))

    def target(self, rotation: Array, position: Array) -> pin.SE3:
        """Pose of rotation (3, 3) and position (3,) m as Pinocchio keeps it."""
        return pin.SE3(rotation, position)
