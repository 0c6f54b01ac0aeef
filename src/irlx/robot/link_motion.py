"""Where a link is and how the joints move it: what constraints of a link are computed from."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics
from irlx.solids.placement import Vector3

Array = NDArray[np.float64]

_ALIGNED = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED


class LinkState(NamedTuple):
    """A link at one posture: its `pose`, an SE3 in the root frame, and how a joint step d moves it.

    `jacobian` (6, n) times d is the motion of the joint that carries the link: that of its origin in the
    root frame, then the turn w. The link's origin lies `arm` (m, in the root frame) from there, and moves
    by w x arm beside.
    """

    pose: pin.SE3
    arm: Vector3
    jacobian: Array

    def rates(self, coefficients: list[tuple[Vector3, Vector3]]) -> Array:
        """Rows (k, n) of k combinations  a . v + b . w  of the link's velocity v and turn w, by a and b."""
        px, py, pz = self.arm
        rows = []
        for (ax, ay, az), (bx, by, bz) in coefficients:
            # a . (w x arm) = w . (arm x a).
            rows.append([ax, ay, az, bx + py * az - pz * ay, by + pz * ax - px * az, bz + px * ay - py * ax])
        return np.asarray(np.array(rows) @ self.jacobian)


class LinkMotion:
    """States of one link of a robot."""

    def __init__(self, kinematics: Kinematics, link: str) -> None:
        self._kinematics, self._model = kinematics, kinematics.model
        self._data: Any = self._model.createData()
        self._joint, self._in_joint = kinematics.body_of(link)
        self._at_joint = bool(self._in_joint.isIdentity(0.0))
        self._still = np.zeros((6, kinematics.joints))

    def pose(self, q: Array) -> pin.SE3:
        """The link's pose in the root frame at posture q (n,)."""
        pin.forwardKinematics(self._model, self._data, self._kinematics.expanded(q))
        return self._data.oMi[self._joint] * self._in_joint

    def at(self, q: Array) -> LinkState:
        """The link's state at posture q (n,)."""
        if self._joint == 0:
            return LinkState(self._in_joint, (0.0, 0.0, 0.0), self._still)
        pin.computeJointJacobians(self._model, self._data, self._kinematics.expanded(q))
        by_joints = pin.getJointJacobian(self._model, self._data, self._joint, _ALIGNED)
        jacobian = self._kinematics.by_axes(by_joints)
        pose = self._data.oMi[self._joint]
        if self._at_joint:
            return LinkState(pin.SE3(pose), (0.0, 0.0, 0.0), jacobian)
        moved = pose * self._in_joint
        x, y, z = (moved.translation - pose.translation).tolist()
        return LinkState(moved, (x, y, z), jacobian)
