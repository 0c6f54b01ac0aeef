"""PlaCo: problem and solver in C++, called from Python once a solve."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import placo
from numpy.typing import NDArray

from beside.following import MET, Make, answers
from beside.line_and_circle import START, TIP
from beside.serving import serve_standard_input

Array = NDArray[np.float64]

PACKAGES = ("placo", "pin", "numpy")
REGULARIZATION = 1e-6
"""What its documentation uses; less or none does not change the time."""

OF_THE_BASE = 7
"""Values of the floating base in front of the joints' in PlaCo's state; it is masked."""


class PlacoFollower:
    """Least motion by PlaCo with its own limits of position and speed."""

    def __init__(self, urdf: Path, constrained: bool, dt: float) -> None:
        self._robot = placo.RobotWrapper(str(urdf), placo.Flags.ignore_collisions)
        self._solver = placo.KinematicsSolver(self._robot)
        self._solver.mask_fbase(True)
        self._solver.enable_joint_limits(True)
        self._solver.enable_velocity_limits(True)
        self._solver.dt = dt
        for name, value in zip(self._robot.joint_names(), START, strict=True):
            self._robot.set_joint(name, value)
        self._robot.update_kinematics()
        self._target = np.array(self._robot.get_T_world_frame(TIP))
        self._tool = self._solver.add_frame_task(TIP, self._target)
        self._tool.configure("tool", "hard" if constrained else "soft", 1.0, 1.0)
        self._solver.add_regularization_task(REGULARIZATION)
        self._parts = self._tool.position(), self._tool.orientation()

    def aim(self, position: Array) -> None:
        """Take the position of the next tick."""
        self._target[:3, 3] = position
        self._tool.T_world_frame = self._target

    def solve(self) -> bool:
        """Solve once; whether the pose is met."""
        self._solver.solve(True)
        self._robot.update_kinematics()
        for part in self._parts:
            part.update()
        return all(part.error_norm() <= MET for part in self._parts)

    @property
    def q(self) -> Array:
        """Posture (7,), rad."""
        found: Array = self._robot.state.q[OF_THE_BASE:]
        return found


def followers(folder: Path) -> Make:
    """Followers on the URDF of the folder."""
    return lambda case, dt: PlacoFollower(folder / "bare.urdf", case == "constraint", dt)


if __name__ == "__main__":
    serve_standard_input(lambda folder: answers(followers(folder)), PACKAGES)
