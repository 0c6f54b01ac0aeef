"""mink on MuJoCo, with a QP solver by qpsolvers."""

from __future__ import annotations

import warnings
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import mink
import mujoco
import numpy as np
from numpy.typing import NDArray

from beside.following import Make, answers, met
from beside.line_and_circle import START, TIP
from beside.serving import serve_standard_input

Array = NDArray[np.float64]

PACKAGES = ("mink", "mujoco", "qpsolvers", "daqp", "quadprog", "numpy")
DAMPING = 1e-8


class MinkFollower:
    """Least motion by mink with its own limits of position and speed."""

    def __init__(
        self, model: Any, speeds: dict[str, float], solver: str, constrained: bool, dt: float
    ) -> None:
        self._configuration = mink.Configuration(model, START)
        self._tool = mink.FrameTask(TIP, "body", position_cost=1.0, orientation_cost=1.0)
        self._rotation = self._configuration.get_transform_frame_to_world(TIP, "body").rotation()
        settings: dict[str, Any] = {"tasks": [self._tool], "damping": DAMPING}
        if constrained:
            settings = {"tasks": [], "constraints": [self._tool], "damping": 1.0}
        limits = [mink.ConfigurationLimit(model), mink.VelocityLimit(model, speeds)]
        self._settings = {"dt": dt, "solver": solver, "limits": limits, **settings}
        self._dt = dt

    def aim(self, position: Array) -> None:
        """Take the position of the next tick."""
        self._tool.set_target(mink.SE3.from_rotation_and_translation(self._rotation, position))

    def solve(self) -> bool:
        """Solve once; whether the pose is met."""
        speed = mink.solve_ik(self._configuration, **self._settings)
        self._configuration.integrate_inplace(speed, self._dt)
        return met(self._tool.compute_error(self._configuration))

    @property
    def q(self) -> Array:
        """Posture (7,), rad."""
        found: Array = self._configuration.q
        return found


def followers(folder: Path) -> Make:
    """Followers on the URDF of the folder, read by MuJoCo with every link of its own."""
    robot = ET.fromstring((folder / "bare.urdf").read_text(encoding="utf-8"))
    speeds = {
        joint.get("name", ""): float(limit.get("velocity", "inf"))
        for joint in robot.findall("joint")
        if (limit := joint.find("limit")) is not None
    }
    compiler = '<mujoco><compiler fusestatic="false" balanceinertia="true"/></mujoco>'
    robot.insert(0, ET.fromstring(compiler))
    model = mujoco.MjModel.from_xml_string(ET.tostring(robot, encoding="unicode"))

    def make(case: str, dt: float) -> MinkFollower:
        solver, _, form = case.partition(", ")
        return MinkFollower(model, speeds, solver, form == "constraint", dt)

    return make


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    serve_standard_input(lambda folder: answers(followers(folder)), PACKAGES)
