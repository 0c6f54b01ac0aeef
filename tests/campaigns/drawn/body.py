"""A drawn robot in its cell, as the writer of a program sees it: poses of postures, units, sizes of moves."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from drawn.robots import Robot
from irlx.cell.cell import Cell
from irlx.robot.kinematics import Kinematics
from irlx.verifier.geometry.forward import forward

TICKS = (0.25, 0.5, 1.0, 2.0, 4.0, 5.0, 10.0, 20.0, 50.0)
"""Ticks of the cells, ms."""

Pose = tuple[np.ndarray, Rotation]
"""Position, m, and orientation in the root frame."""


def number(value: float) -> str:
    """A number that reads back as the very same."""
    return repr(float(value))


def join(values) -> str:
    return ", ".join(number(value) for value in values)


@dataclass
class Body:
    """A robot in its cell.

    `speed` m/s and `span` s say how fast and long an ordinary move of a program is; `obstacles`, `frames` and
    `hand_frame` are names of the cell, `spare` the joints that may be frozen.
    """

    robot: Robot
    cell: Cell
    text: str
    tick: float
    speed: float
    span: float
    obstacles: list[str] = field(default_factory=list)
    hand_frame: str = ""
    relation: tuple[int, int, float] | None = None
    """Two joints a, b and a factor f of a condition of the cell: a + f b stays."""
    bounds: tuple[np.ndarray, np.ndarray] = (np.zeros(0), np.zeros(0))
    """Position limits in units of the program, to the last digit where the cell gives them."""
    special: set[str] = field(default_factory=set)

    @property
    def n(self) -> int:
        return self.cell.start.size

    @property
    def start(self) -> np.ndarray:
        return self.cell.start

    @cached_property
    def units(self) -> np.ndarray:
        """Units of a program for one rad or m of each joint."""
        return np.array([1e3 if axis.is_prismatic else np.degrees(1.0) for axis in self.cell.robot.axes])

    @property
    def rows(self) -> int:
        return len(self.cell.robot.coordinates) + (self.relation is not None)

    @property
    def spare(self) -> int:
        return max(self.n - self.rows, 0)

    @property
    def way(self) -> float:
        """Length of an ordinary move, m."""
        return 0.6 * self.speed * self.span

    @property
    def spread(self) -> float:
        """Turn of a joint that goes with it, rad (slides: m)."""
        return min(self.way / self.robot.size, 0.25)

    def pose(self, q: np.ndarray) -> Pose:
        """Pose of the tip by the verifier's forward kinematics."""
        positions, rotations = forward(self.cell.robot, q[None])
        return positions[0], Rotation.from_matrix(rotations[0])

    @cached_property
    def home(self) -> Pose:
        return self.pose(self.start)

    def values(self, q: np.ndarray) -> np.ndarray:
        """Joint values in units of the program, none outside the limits by rounding."""
        return np.clip(q * self.units, *self.bounds)

    def inside(self, q: np.ndarray) -> np.ndarray:
        """Joint values within the limits, and as the condition of the cell asks for where they allow it."""
        lower, upper = self.cell.limits.pair("position")
        q = np.clip(q, lower, upper)
        if self.relation is not None:
            a, b, factor = self.relation
            q[a] = self.start[a] - factor * (q[b] - self.start[b])
            if not lower[a] <= q[a] <= upper[a]:
                q[[a, b]] = self.start[[a, b]]
        return q


def singular(kinematics: Kinematics, q: np.ndarray) -> float:
    """Smallest singular value of the task in a posture."""
    rotation, position = kinematics.tool_pose(q)
    jacobian = kinematics.difference(q, kinematics.target(rotation, position))[1]
    return float(np.linalg.svd(jacobian, compute_uv=False)[-1])
