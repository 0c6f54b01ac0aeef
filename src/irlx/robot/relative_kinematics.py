"""The tool of a robot as a frame sees it that moves with another of its links."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
import pinocchio as pin

from irlx.blocks.link_frame import LinkFrame
from irlx.robot.equality import Constraint
from irlx.robot.implied import implied_by_pose
from irlx.robot.kinematics import Array, Kinematics

_LOCAL = pin.ReferenceFrame.LOCAL


class RelativeKinematics(Kinematics):
    """Poses and Jacobian of the tool in a frame F of the same robot, as in one arm that begins at F.

    T = T_F^-1 T_tool, and in the tool frame J = J_tool - Ad(T^-1) J_F, with J_F in the frame F: a joint step
    d moves the tool, as F sees it, by the twist J d to first order. All joints of the chain from F through
    the root to the tool may have a part in it; those that carry both alike have none.
    """

    def __init__(self, world: Kinematics, frame: LinkFrame) -> None:
        """Raises KeyError where the robot has no such link."""
        super().__init__(world.description, world.constraints, world.tool)
        self._world = world
        self._named = frame
        parent, in_parent = self.body_of(frame.link)
        x, y, z, w = frame.orientation
        turn = pin.Quaternion(w, x, y, z).normalized().toRotationMatrix()
        own = in_parent * pin.SE3(turn, np.array(frame.position))
        # Two robots may have links of any name, so that the frame's own tells it from the tip's.
        name = f"frame {frame.name}"
        self._seen_by = self.model.addFrame(pin.Frame(name, parent, 0, own, pin.FrameType.OP_FRAME))
        self.data = self.model.createData()
        lever = self.description.lever + self.description.lever_to(frame.link)
        self.row_scale[: self.task.linear] = 1.0 / lever

    @property
    def frame(self) -> LinkFrame:
        """The frame F."""
        return self._named

    @property
    def end_frames(self) -> tuple[int, int]:
        """Numbers in `model.frames` of the tool and of the frame F."""
        return self._tip_frame, self._seen_by

    @cached_property
    def of_pose(self) -> Kinematics:
        """The same robot seen from the same frame, without constraints that its pose there implies."""
        implied = implied_by_pose(self) if self.constraints else ()
        if not implied:
            return self
        kept = [item for item in self.constraints if item not in implied]
        found = RelativeKinematics(self._world.constrained(kept), self.frame)
        found.implied = implied
        return found

    @property
    def world(self) -> Kinematics:
        """The same robot, the poses of its tool told in the world."""
        return self._world

    def constrained(self, constraints: Sequence[Constraint]) -> Kinematics:
        """The same robot seen from the same frame, with conditions between its joints."""
        return RelativeKinematics(self._world.constrained(constraints), self.frame)

    def with_tool(
        self, position: tuple[float, float, float], orientation: tuple[float, float, float, float]
    ) -> Kinematics:
        """The same robot seen from the same frame, its tool frame elsewhere on the tip."""
        return RelativeKinematics(self._world.with_tool(position, orientation), self.frame)

    def tool_pose(self, q: Array) -> tuple[Array, Array]:
        """Rotation (3, 3) and position (3,) m of the tool frame in the frame F."""
        pin.forwardKinematics(self.model, self.data, self.expanded(q))
        pose = self._seen()
        return pose.rotation, pose.translation

    def tool_poses(self, q: Array) -> tuple[Array, Array]:
        """Rotations (N, 3, 3) and positions (N, 3) m of the tool frame in F at the postures q (N, n)."""
        rotation, position = np.empty((len(q), 3, 3)), np.empty((len(q), 3))
        for k, row in enumerate(q):
            rotation[k], position[k] = self.tool_pose(row)
        return rotation, position

    def _seen(self) -> pin.SE3:
        """T at the posture that the data hold."""
        tool = pin.updateFramePlacement(self.model, self.data, self._tip_frame)
        return pin.updateFramePlacement(self.model, self.data, self._seen_by).actInv(tool)

    def _pose_and_jacobian(self, q: Array) -> tuple[pin.SE3, Array]:
        pin.computeJointJacobians(self.model, self.data, self.expanded(q))
        pose = self._seen()
        return pose, self.by_axes(self._motions(pose))

    def tool_motions(self, q: Array) -> Array:
        """Jacobian of T in the tool frame by all N joints of `model`, (6, N), each of them moving alone."""
        pin.computeJointJacobians(self.model, self.data, self.expanded(q))
        return self._motions(self._seen())

    @cached_property
    def nearer_tool(self) -> Array:
        """1 at (i, j) where joint j comes after joint i on the way from F through the root to the tool."""
        places = np.arange(self.model.nv)
        of_tool = set(self.model.supports[self.model.frames[self._tip_frame].parentJoint])
        for joint in self.model.supports[self.model.frames[self._seen_by].parentJoint]:
            if joint not in of_tool:
                # On this arm the way leads from its hand to its base.
                places[joint - 1] = -joint
        return (places[None] > places[:, None]).astype(np.float64)

    def _motions(self, pose: pin.SE3) -> Array:
        of_tool = pin.getFrameJacobian(self.model, self.data, self._tip_frame, _LOCAL)
        of_frame = pin.getFrameJacobian(self.model, self.data, self._seen_by, _LOCAL)
        return np.asarray(of_tool - pose.inverse().action @ of_frame)
