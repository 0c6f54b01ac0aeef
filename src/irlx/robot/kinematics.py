"""The kinematic model of a robot: tool pose, pose difference and Jacobian, by Pinocchio."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from irlx.blocks.link_frame import LinkFrame
from irlx.robot.description import COORDINATES, Joint, RobotDescription
from irlx.robot.equality import Constraint
from irlx.robot.implied import implied_by_pose
from irlx.robot.joint_models import displacement, inertia_of, joint_model, placement
from irlx.robot.pose_targets import PoseTargets
from irlx.robot.task import Task, framed_difference, partial_difference, pose_errors

if TYPE_CHECKING:
    from irlx.robot.chain_batch import ChainBatch

Array = NDArray[np.float64]

_POSTURES = 4
_MANY = 24
_STILL = 1e-9
_ROUNDING = 1e-10
_LOCAL = pin.ReferenceFrame.LOCAL


def _coupling(description: RobotDescription) -> tuple[Array | None, Array]:
    """A (N, n) and b (N,) of q_all = A q + b for N moving joints; None for A where none follows another."""
    coupling = description.coupling
    offsets = np.array([offset for _, _, offset in coupling])
    if len(coupling) == len(description.axes):
        return None, offsets
    matrix = np.zeros((len(coupling), len(description.axes)))
    for joint, (axis, multiplier, _) in enumerate(coupling):
        matrix[joint, axis] = multiplier
    return matrix, offsets


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

    Pinocchio's `model` has a joint for each of `RobotDescription.moving`, N in all: those that follow others
    are among them. Its configuration is `expanded(q)` = A q + b, and what it gives by joints, (.., N), is by
    axes `by_axes` of it.
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
        self._moving_names = {joint.name for joint in description.moving}
        self._children: dict[str, list[Joint]] = {}
        for joint in description.joints:
            self._children.setdefault(joint.parent, []).append(joint)
        self._tip_frame = -1
        self._relative: dict[LinkFrame, Kinematics] = {}
        self._bodies: dict[str, tuple[int, pin.SE3]] = {}
        self._add_link(description.root, 0, pin.SE3.Identity())
        self.data = self.model.createData()
        self.joints = len(description.axes)
        self.coupling, self._offsets = _coupling(description)
        self._frame = self._task_frame()
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

    @property
    def end_frames(self) -> tuple[int, int]:
        """Numbers in `model.frames` of the tool and of the frame in which its poses are told."""
        return self._tip_frame, 0

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
                self.model.appendBodyToJoint(parent, inertia_of(inertial), in_parent)
        if link == self.description.tip:
            frame = pin.Frame(link, parent, 0, in_parent * self.tool, pin.FrameType.OP_FRAME)
            self._tip_frame = self.model.addFrame(frame)
        for joint in self._children.get(link, []):
            origin = in_parent * placement(joint.xyz, joint.rpy)
            if joint.name in self._moving_names:
                index = self.model.addJoint(parent, joint_model(joint), origin, joint.name)
                self._add_link(joint.child, index, pin.SE3.Identity())
            else:
                held_at = self.description.locked.get(joint.name, 0.0)
                self._add_link(joint.child, parent, origin * displacement(joint, held_at))

    def _task_frame(self) -> tuple[int, Array] | None:
        """Pinocchio joint that carries the frame of the task, and its rotation there; None for the tool's."""
        if self.description.task_frame is None:
            return None
        joint, within = self._bodies[self.description.task_frame]
        return joint, within.rotation

    def expanded(self, q: Array) -> Array:
        """Values (.., N) of all joints of `model` at joint vectors (.., n): A q + b."""
        return q if self.coupling is None else q @ self.coupling.T + self._offsets

    def by_axes(self, by_joints: Array) -> Array:
        """Derivatives by the axes (.., n) from those by all joints of `model` (.., N)."""
        return by_joints if self.coupling is None else np.asarray(by_joints @ self.coupling)

    def body_of(self, link: str) -> tuple[int, pin.SE3]:
        """Pinocchio joint that carries a link, 0 for the world, and the link's frame in that joint's."""
        return self._bodies[link]

    def tool_pose(self, q: Array) -> tuple[Array, Array]:
        """Rotation (3, 3) and position (3,) m of the tool frame in the world."""
        pin.forwardKinematics(self.model, self.data, self.expanded(q))
        pose = pin.updateFramePlacement(self.model, self.data, self._tip_frame)
        return pose.rotation.copy(), pose.translation.copy()

    def tool_poses(self, q: Array) -> tuple[Array, Array]:
        """Rotations (N, 3, 3) and positions (N, 3) m of the tool frame at the postures q (N, n)."""
        rotation, position = np.empty((len(q), 3, 3)), np.empty((len(q), 3))
        model, data, tip = self.model, self.data, self._tip_frame
        forward, place = pin.forwardKinematics, pin.updateFramePlacement
        # Views of what is written at each row: to ask for them anew costs as much as the kinematics.
        turned, placed = data.oMf[tip].rotation, data.oMf[tip].translation
        for k, row in enumerate(self.expanded(q)):
            forward(model, data, row)
            place(model, data, tip)
            rotation[k], position[k] = turned, placed
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

    def differences(self, q: Array, targets: PoseTargets) -> tuple[Array, Array]:
        """`difference` of each of the postures q (N, n) and its target: (N, m) and (N, m, n).

        Of many at once it is the same but for rounding.
        """
        if self._plain and len(q) >= _MANY:
            found = self._batch.differences(q, (targets.rotation, targets.position))
            return np.ascontiguousarray(found[0]), np.ascontiguousarray(found[1])
        twists, jacobians = np.empty((len(q), self.rows)), np.empty((len(q), self.rows, self.joints))
        for k, (row, target) in enumerate(zip(q, targets, strict=True)):
            twists[k], jacobians[k] = self.difference(row, target)
        return twists, jacobians

    @cached_property
    def _batch(self) -> ChainBatch:
        # Imported here: it is built from a Kinematics.
        from irlx.robot.chain_batch import ChainBatch

        return ChainBatch(self)

    def tool_difference(self, q: Array, target: pin.SE3) -> tuple[Array, Array]:
        """log6(T(q)^-1 T_target), shape (6,), and the tool Jacobian, shape (6, n), whatever the task."""
        pose, jacobian = self._pose_and_jacobian(q)
        return pin.log6(pose.actInv(target)).vector, jacobian

    def _pose_and_jacobian(self, q: Array) -> tuple[pin.SE3, Array]:
        """Pose of the tool, in a buffer, and its Jacobian (6, n) in the tool frame."""
        if self.coupling is not None:
            q = self.expanded(q)
        pin.computeJointJacobians(self.model, self.data, q)
        pose = pin.updateFramePlacement(self.model, self.data, self._tip_frame)
        jacobian = pin.getFrameJacobian(self.model, self.data, self._tip_frame, _LOCAL)
        if self.model.nv == 1:
            # Of a single joint it comes as a vector.
            jacobian = jacobian.reshape(6, 1)
        return pose, jacobian if self.coupling is None else jacobian.dot(self.coupling)

    def tool_motions(self, q: Array) -> Array:
        """Tool Jacobian in the tool frame by all N joints of `model`, (6, N), each of them moving alone."""
        pin.computeJointJacobians(self.model, self.data, self.expanded(q))
        return np.array(pin.getFrameJacobian(self.model, self.data, self._tip_frame, _LOCAL)).reshape(6, -1)

    @cached_property
    def carried(self) -> Array:
        """1 at (i, j) where joint i of `model` carries joint j and is another one, else 0, (N, N)."""
        found = np.zeros((self.model.nv, self.model.nv))
        for joint in range(1, self.model.njoints):
            found[[above - 1 for above in self.model.supports[joint] if above], joint - 1] = 1.0
        np.fill_diagonal(found, 0.0)
        return found

    @cached_property
    def nearer_tool(self) -> Array:
        """1 at (i, j) where joint j of `model` comes after joint i on the way to the tool, else 0, (N, N)."""
        return np.triu(np.ones((self.model.nv, self.model.nv)), 1)

    def difference_derivative(self, q: Array, target: pin.SE3) -> tuple[Array, Array]:
        """What `difference` gives first and its exact derivative by q, (m, n), also far from the target.

        With E = T(q)^-1 T_target a step d turns E into exp(-J d) E, so d log6(E) = -Jlog6(E) Ad(E^-1) J d.
        """
        left, matrix = self._rows(q, target, exact=True)
        return left, -matrix

    def _rows(self, q: Array, target: pin.SE3, exact: bool) -> tuple[Array, Array]:
        pose, matrix = self._pose_and_jacobian(q)
        if not self.task.is_whole:
            left, matrix = self._part(self.task, pose, matrix, target)
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

    def _part(self, task: Task, pose: pin.SE3, jacobian: Array, target: pin.SE3) -> tuple[Array, Array]:
        """Coordinates of a task and their matrix, at the posture of the last call of `tool_difference`."""
        if self._frame is None:
            return partial_difference(task, pose, jacobian, target)
        joint, within = self._frame
        frame = self.data.oMi[joint].rotation @ within
        return framed_difference(task, frame, pose, jacobian, self._turns_of_frame(frame), target)

    def _turns_of_frame(self, frame: Array) -> Array:
        """Angular velocity (3, n) of the task's frame, in its own axes, by the joints."""
        assert self._frame is not None
        # Joints of other branches do not turn it.
        carry = [joint - 1 for joint in self.model.supports[self._frame[0]] if joint > 0]
        turns = np.zeros((3, self.model.nv))
        turns[:, carry] = self.data.J[3:, carry]
        return self.by_axes(frame.T @ turns)

    def task_frames(self, q: Array) -> Array:
        """Rotations (N, 3, 3) in the world of the frame in which the task's coordinates are, at q (N, n)."""
        if self._frame is None:
            return self.tool_poses(q)[0]
        joint, within = self._frame
        found = np.empty((len(q), 3, 3))
        for k, row in enumerate(self.expanded(q)):
            pin.forwardKinematics(self.model, self.data, row)
            found[k] = self.data.oMi[joint].rotation @ within
        return found

    def errors(
        self, q: Array, wanted: tuple[Array, Array], reached: tuple[Array, Array] | None = None
    ) -> tuple[Array, Array]:
        """Distance (N,) m and angle (N,) rad between the poses of postures q (N, n) and those wanted.

        Poses are rotations (N, 3, 3) and positions (N, 3), those `reached` what `tool_poses` gives of q, if
        it is known already; what counts are the coordinates of the task.
        """
        reached = self.tool_poses(q) if reached is None else reached
        frames = None if self.task.is_whole or self._frame is None else self.task_frames(q)
        return pose_errors(self.task, wanted, reached, frames)

    def left_of(self, task: Task, q: Array, target: pin.SE3) -> Array:
        """What is left from posture q to a target in the coordinates of some task, in the task's frame."""
        pose, jacobian = self._pose_and_jacobian(q)
        return self._part(task, pose, jacobian, target)[0]

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
    def usual_motions(self) -> Array:
        """Matrices (P, 6, n) by which joints move the tool in the frame of the task, displacements divided by
        the reach, at postures with nothing special about them."""
        found = []
        for k in range(_POSTURES):
            # Joint values without any pattern: what is zero at all of them is so everywhere.
            q = np.sin(np.arange(1.0, self.joints + 1.0) * (1.7 + k))
            target = self.target(*self.tool_pose(q))
            pose, jacobian = self._pose_and_jacobian(q)
            found.append(self._part(Task(), pose, jacobian, target)[1])
        units = np.array([self.description.reach] * 3 + [1.0] * 3)
        return np.asarray(found / units[:, None])

    @cached_property
    def immovable(self) -> Task:
        """Coordinates that the task leaves out and no joint moves either, as a planar arm's height."""
        if self.task.is_whole:
            return Task(())
        moved = np.max(np.abs(self.usual_motions), axis=(0, 2), initial=0.0)
        # Lengths count as they are here, and not in reaches.
        moved[:3] *= self.description.reach
        still = moved <= _STILL * max(1.0, self.description.reach)
        names = (name for name in self.task.left_out if name not in self.description.free)
        return Task(tuple(name for name in names if still[COORDINATES.index(name)]))

    @cached_property
    def following(self) -> Task:
        """Coordinates that the task leaves out, that joints move, and that are not free: where `unbound` is
        empty they follow from the others."""
        free, still = self.description.free, self.immovable.coordinates
        return Task(tuple(name for name in self.task.left_out if name not in free and name not in still))

    @cached_property
    def leaves_turns(self) -> bool:
        """Whether joints turn the tool in ways that nobody asks for: a pose met is not the pose asked for."""
        return bool(self.description.free) or self.following.size > 0

    @cached_property
    def unbound(self) -> Task:
        """Those of `following` that joints move whatever the others are."""
        own = list(self.task.rows)
        rank = self._usual_rank(own)
        loose = (self._usual_rank([*own, row]) > rank for row in self.following.rows)
        return Task(
            tuple(name for name, moves in zip(self.following.coordinates, loose, strict=True) if moves)
        )

    @cached_property
    def task_rank(self) -> int:
        """How many coordinates of the task joints move independently at nearly all postures."""
        return self._usual_rank(list(self.task.rows))

    def _usual_rank(self, rows: list[int]) -> int:
        ranks = []
        for motions in self.usual_motions:
            values = np.linalg.svd(motions[rows], compute_uv=False)
            ranks.append(
                int(np.count_nonzero(values > _ROUNDING * max(1.0, values[0]))) if values.size else 0
            )
        return max(ranks)

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
