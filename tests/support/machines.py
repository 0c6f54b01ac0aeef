"""Robots with everything the planning of a motion asks for, from their cells by name."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pinocchio as pin
from scipy.spatial.transform import Rotation

from irlx.cell.load import load_cell
from irlx.motion.line import Line
from irlx.motion.trapezoid import Trapezoid
from irlx.motion.whole_ticks import whole_ticks
from irlx.pacing.demand import demands
from irlx.pacing.slowdown.model import Model
from irlx.pacing.slowdown.planned import MotionTask, Ticking
from irlx.robot.description import RobotDescription
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.transform.criteria.least_motion import LeastMotion
from irlx.verifier.geometry.forward import forward


@dataclass(frozen=True)
class Machine:
    """A robot with its own limits, weights n .. 1, and a start posture."""

    robot: RobotDescription
    limits: JointLimits
    weights: np.ndarray
    start: np.ndarray

    @property
    def n(self) -> int:
        return self.start.size

    @property
    def kinematics(self) -> Kinematics:
        return Kinematics(self.robot)

    def model(self, limits: JointLimits | None = None, frozen: tuple[int, ...] = ()) -> Model:
        """Model with all joints free but those in `frozen` (from 0)."""
        free = np.ones(self.n, dtype=bool)
        free[list(frozen)] = False
        return Model(self.kinematics, self.limits if limits is None else limits, self.weights, free)

    def unlimited(self) -> JointLimits:
        return JointLimits.unlimited(self.n)

    def pose(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Position and rotation of the tool by the verifier's own forward kinematics."""
        positions, rotations = forward(self.robot, np.atleast_2d(q))
        return positions[0], rotations[0]

    def line(self, way=(0.0, -0.4, 0.0), turn=(0.0, 0.0, 0.0), start: np.ndarray | None = None) -> Line:
        """Line from the pose of a posture by a way (m, world) and a turn (rotation vector, tool axes)."""
        position, rotation = self.pose(self.start if start is None else start)
        end = rotation @ Rotation.from_rotvec(turn).as_matrix()
        return Line(position, rotation, position + np.asarray(way, dtype=float), end)

    def task(
        self, path: Line, law: Trapezoid, dt: float = 0.01, start: np.ndarray | None = None
    ) -> MotionTask:
        """A least-motion task along a path."""
        least = LeastMotion(self.weights)
        start = self.start if start is None else start
        ticking = Ticking(dt, lambda time: whole_ticks(time, dt), lambda clock: demands(path, clock, 1))
        return MotionTask(path, law, law.acc, start, lambda s, _: least, ticking)

    def errors(self, q: np.ndarray, poses) -> tuple[float, float]:
        """Largest distance (m) and angle (rad) of postures (N, n) from poses."""
        positions, rotations = forward(self.robot, q)
        apart = np.swapaxes(poses.rotation, 1, 2) @ rotations
        sine = 0.5 * np.linalg.norm(
            [apart[:, i, j] - apart[:, j, i] for i, j in ((2, 1), (0, 2), (1, 0))], axis=0
        )
        return float(np.linalg.norm(positions - poses.position, axis=1).max()), float(np.arcsin(sine).max())


@cache
def machine(name: str) -> Machine:
    """A robot by the name of its cell, at the start of the reference motion."""
    starts = {"panda": [0.45, 0.35, -0.25, -1.9, 0.1, 2.25, 0.9]}
    with TemporaryDirectory() as folder:
        cell = Path(folder) / "cell.toml"
        cell.write_text(f'[robot]\nmodel = "{name}"\n', encoding="utf-8")
        loaded = load_cell(cell)
    start = np.array(starts[name]) if name in starts else loaded.start
    return Machine(loaded.robot, loaded.limits, np.arange(start.size, 0.0, -1.0), start)


def least_motion(machine: Machine, poses, q: np.ndarray) -> np.ndarray:
    """Postures (N, n) of a plain weighted Newton walk along poses from q: no solver of irlx, no limits."""
    model, inverse = machine.kinematics, 1.0 / machine.weights
    rows = []
    for rotation, position in zip(poses.rotation, poses.position, strict=True):
        target, old = pin.SE3(rotation, position), q
        for _ in range(8):
            twist, jacobian = model.difference(q, target)
            pull = inverse[:, None] * jacobian.T
            q = old + pull @ np.linalg.solve(jacobian @ pull, twist + jacobian @ (q - old))
        rows.append(q)
    return np.array(rows)
