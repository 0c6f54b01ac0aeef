"""Pink (PyPI: pin-pink) on Pinocchio, with a QP solver by qpsolvers."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray
from pink import Configuration, solve_ik
from pink.tasks import FrameTask

from beside.following import Make, answers, met
from beside.line_and_circle import START, TIP
from beside.serving import serve_standard_input

Array = NDArray[np.float64]

PACKAGES = ("pin-pink", "pin", "qpsolvers", "daqp", "quadprog", "numpy")
DAMPING = 1e-8
"""Of the pose as a task: as little as lets both solvers come to the same posture."""


class PinkFollower:
    """Least motion by Pink with its own limits of position and speed."""

    def __init__(self, model: Any, solver: str, constrained: bool, dt: float) -> None:
        self._configuration = Configuration(model, model.createData(), START)
        self._tool = FrameTask(TIP, position_cost=1.0, orientation_cost=1.0)
        self._rotation = self._configuration.get_transform_frame_to_world(TIP).rotation
        settings: dict[str, Any] = {"tasks": [self._tool], "damping": DAMPING}
        if constrained:
            settings = {"tasks": [], "constraints": [self._tool], "damping": 1.0}
        self._settings = {"dt": dt, "solver": solver, **settings}
        self._dt = dt

    def aim(self, position: Array) -> None:
        """Take the position of the next tick."""
        self._tool.set_target(pin.SE3(self._rotation, position))

    def solve(self) -> bool:
        """Solve once; whether the pose is met."""
        speed = solve_ik(self._configuration, **self._settings)
        self._configuration.integrate_inplace(speed, self._dt)
        return met(self._tool.compute_error(self._configuration))

    @property
    def q(self) -> Array:
        """Posture (7,), rad."""
        found: Array = self._configuration.q
        return found


def followers(folder: Path) -> Make:
    """Followers on the URDF of the folder."""
    model = pin.buildModelFromXML((folder / "bare.urdf").read_text(encoding="utf-8"))

    def make(case: str, dt: float) -> PinkFollower:
        solver, _, form = case.partition(", ")
        return PinkFollower(model, solver, form == "constraint", dt)

    return make


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    serve_standard_input(lambda folder: answers(followers(folder)), PACKAGES)
