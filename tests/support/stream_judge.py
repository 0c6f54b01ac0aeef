"""An independent judge of written streams: NPZ file in, figures out; nothing of irlx is imported.

Forward kinematics by Pinocchio's own URDF reader, speeds and accelerations by backward differences with one
row of rest before and two after, ways and their parameters in closed form.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import pinocchio as pin
from scipy.spatial.transform import Rotation

Pair = tuple[np.ndarray, np.ndarray]

ON_PATH = 1e-6
"""Promised distance from the path, m and rad."""


@cache
def _model(urdf: str) -> pin.Model:
    return pin.buildModelFromXML(urdf)


def tool_poses(urdf: str, tip: str, names: tuple[str, ...], q: np.ndarray) -> tuple[np.ndarray, Rotation]:
    """Tool positions (N, 3) m and orientations of postures q (N, n); joints without a column stand at 0."""
    model = _model(urdf)
    data, frame = model.createData(), model.getFrameId(tip)
    columns = [model.joints[model.getJointId(name)].idx_q for name in names]
    positions, rotations = np.empty((len(q), 3)), np.empty((len(q), 3, 3))
    configuration = pin.neutral(model)
    for k, row in enumerate(q):
        configuration[columns] = row
        pin.forwardKinematics(model, data, configuration)
        pose = pin.updateFramePlacement(model, data, frame)
        positions[k], rotations[k] = pose.translation, pose.rotation
    return positions, Rotation.from_matrix(rotations)


@dataclass(frozen=True)
class Excess:
    """How far rows pass their bounds, beyond what is promised: at most 0 where all are kept."""

    position: float
    speed: float
    acceleration: float

    @property
    def none(self) -> bool:
        return max(self.position, self.speed, self.acceleration) <= 0.0


def excess(q: np.ndarray, dt: float, position: Pair, speed: Pair, acceleration: Pair) -> Excess:
    """Excess of rows (N, n) over bounds (n,), by the text of the promise."""
    rest = np.vstack([q[:1], q, q[-1:], q[-1:]])
    v = np.diff(rest, axis=0) / dt
    a = np.diff(v, axis=0) / dt
    unit = float(np.spacing(np.max(np.abs(q))))
    return Excess(
        _beyond(q, position, 0.0, 0.0),
        _beyond(v, speed, 1e-9, 2.0 * unit / dt),
        _beyond(a, acceleration, 1e-9, 4.0 * unit / dt**2),
    )


def _beyond(values: np.ndarray, pair: Pair, relative: float, absolute: float) -> float:
    lower, upper = (np.where(np.isfinite(side), side * (1.0 + relative), side) for side in pair)
    return float(np.max(np.maximum(values - upper - absolute, lower - absolute - values)))


@dataclass(frozen=True)
class OnWay:
    """Distance (m), angle (rad) from a way, and the share of it, for each row (N,)."""

    distance: np.ndarray
    angle: np.ndarray
    share: np.ndarray
    grain: float = 0.0
    """Rounding of positions as a share of the way: much on a way of nanometres."""

    @property
    def kept(self) -> bool:
        """On the way everywhere, never backwards, and at its end at last."""
        off = max(float(self.distance.max()), float(self.angle.max()))
        back = float(np.min(np.diff(self.share), initial=0.0))
        return (
            off <= ON_PATH
            and back >= -1e-9 - self.grain
            and abs(float(self.share[-1]) - 1.0) <= 1e-6 + self.grain
        )


def on_line(
    positions: np.ndarray,
    rotations: Rotation,
    start: tuple[np.ndarray, Rotation],
    end: tuple[np.ndarray, Rotation],
) -> OnWay:
    """Rows against a straight line whose orientation turns about one axis in step with it."""
    way = end[0] - start[0]
    turn = (start[1].inv() * end[1]).as_rotvec()
    length, angle = float(np.linalg.norm(way)), float(np.linalg.norm(turn))
    turned = (start[1].inv() * rotations).as_rotvec()
    # A way much shorter than the turn says little of how far the rows have come.
    if length > 1e-4 * angle:
        share = (positions - start[0]) @ way / length**2
    else:
        share = turned @ turn / angle**2
    wanted = start[1] * Rotation.from_rotvec(share[:, None] * turn)
    distance = np.linalg.norm(positions - start[0] - share[:, None] * way, axis=1)
    grain = 1e-14 / max(length, 1e-4 * angle)
    return OnWay(distance, (wanted.inv() * rotations).magnitude(), share, grain)


def on_circle(
    positions: np.ndarray,
    rotations: Rotation,
    start: tuple[np.ndarray, Rotation],
    centre: np.ndarray,
    axis: np.ndarray,
) -> OnWay:
    """Rows against one full turn of the start about `axis` through `centre`, the orientation kept."""
    arm = start[0] - centre
    across = np.cross(axis, arm)
    out = positions - centre
    phi = np.unwrap(np.arctan2(out @ across, out @ arm), period=2.0 * np.pi)
    # The first row may lie a rounding behind the start.
    phi = phi + (2.0 * np.pi if phi[0] < -1.0 else 0.0)
    wanted = centre + np.cos(phi)[:, None] * arm + np.sin(phi)[:, None] * across
    distance = np.linalg.norm(positions - wanted, axis=1)
    return OnWay(distance, (start[1].inv() * rotations).magnitude(), phi / (2.0 * np.pi))


@dataclass(frozen=True)
class Written:
    """What a written NPZ file holds, and the tool poses by the URDF text."""

    t: np.ndarray
    q: np.ndarray
    block: np.ndarray
    positions: np.ndarray
    rotations: Rotation

    @classmethod
    def read(cls, file: Path, urdf: str, tip: str) -> Written:
        with np.load(file) as data:
            names = tuple(str(name) for name in data["joint_names"])
            t, q, block = data["t"], data["q"], data["block"]
        return cls(t, q, block, *tool_poses(urdf, tip, names, q))

    @property
    def dt(self) -> float:
        return float(self.t[1] - self.t[0])

    def move(self, number: int) -> tuple[tuple[np.ndarray, Rotation], np.ndarray, Rotation]:
        """Pose before the move of that id, and the poses of its rows."""
        rows = np.flatnonzero(self.block == number)
        before = rows[0] - 1
        return (
            (self.positions[before], self.rotations[int(before)]),
            self.positions[rows],
            self.rotations[rows],
        )
