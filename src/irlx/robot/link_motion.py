"""Where a link is and how the joints move it: what constraints of a link are computed from."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics

Array = NDArray[np.float64]

_ALIGNED = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED


class LinkState(NamedTuple):
    """A link at one posture, in the root frame: rotation (3, 3) and position (3,) m of its frame.

    `linear` and `angular` (3, n): velocity of the frame's origin, and angular velocity, of a joint step.
    """

    rotation: Array
    position: Array
    linear: Array
    angular: Array


class LinkMotion:
    """States of one link of a robot; the last one is kept, since residual and derivative ask for the same."""

    def __init__(self, kinematics: Kinematics, link: str) -> None:
        self._model = kinematics.model
        self._data = self._model.createData()
        self._joint, self._in_joint = kinematics.body_of(link)
        self._q = np.full(kinematics.joints, np.nan)
        self._state: LinkState | None = None

    def at(self, q: Array) -> LinkState:
        """The link's state at posture q (n,); valid until the next call."""
        if self._state is None or not np.array_equal(q, self._q):
            self._state, self._q = self._state_at(q), np.array(q)
        return self._state

    def _state_at(self, q: Array) -> LinkState:
        pin.computeJointJacobians(self._model, self._data, q)
        pose = self._data.oMi[self._joint] * self._in_joint
        if self._joint == 0:
            nothing = np.zeros((3, q.size))
            return LinkState(pose.rotation.copy(), pose.translation.copy(), nothing, nothing)
        jacobian = pin.getJointJacobian(self._model, self._data, self._joint, _ALIGNED)
        angular = jacobian[3:]
        arm = pose.translation - self._data.oMi[self._joint].translation
        # The origin of the link moves by w x arm beside that of its joint: w x arm = -[arm]x w.
        linear = jacobian[:3] - pin.skew(arm) @ angular
        return LinkState(pose.rotation.copy(), pose.translation.copy(), linear, angular)
