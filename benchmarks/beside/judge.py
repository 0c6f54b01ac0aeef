"""What postures are worth: how far the tool is from where it should be, and whether limits are kept."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beside.forward_kinematics import Chain
from beside.line_and_circle import FINGERS, START, TIP, off_the_path, positions

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Verdict:
    """Worst distance (m) and angle (rad) of the tool from the demanded poses; what limit was broken."""

    position: float
    orientation: float
    broken: str = ""


class Judge:
    """Judges postures of the task by the kinematics of this folder."""

    def __init__(self, urdf: str, laps: int) -> None:
        self._chain = Chain(urdf, TIP, FINGERS)
        self._laps = laps
        rotation, position = self._chain.poses(START[None, :])
        self._rotation, self.start = rotation[0], position[0]

    @property
    def speeds(self) -> Array:
        """Speed limits (7,), rad/s."""
        return self._chain.limits[2]

    def targets(self, dt: float) -> Array:
        """Positions (N, 3), m, that are demanded at ticks of `dt` s."""
        return positions(self.start, dt, self._laps)

    def of_ticks(self, q: Array, dt: float) -> Verdict:
        """Verdict on postures (N, 7), each against the pose of its tick."""
        targets = self.targets(dt)
        if len(q) != len(targets):
            return Verdict(np.inf, np.inf, f"{len(q)} ticks in place of {len(targets)}")
        rotations, points = self._chain.poses(q)
        away = float(np.linalg.norm(points - targets, axis=1).max())
        return Verdict(away, self._turned(rotations), self._broken(q, dt, self.speeds))

    def of_path(self, q: Array, dt: float, speeds: Array) -> Verdict:
        """Verdict on postures (N, 7) that have taken their time, by their distance from the path."""
        rotations, points = self._chain.poses(q)
        away = float(off_the_path(points, self.start).max())
        return Verdict(away, self._turned(rotations), self._broken(q, dt, speeds))

    def _turned(self, rotations: Array) -> float:
        """Largest angle, rad, to the orientation of the start, by the skew part: these are small."""
        turn = self._rotation.T @ rotations
        skew = (turn - np.swapaxes(turn, 1, 2)) / 2.0
        return float(np.linalg.norm(skew[:, (2, 0, 1), (1, 2, 0)], axis=1).max())

    def _broken(self, q: Array, dt: float, speeds: Array) -> str:
        lower, upper, _ = self._chain.limits
        if np.any(q < lower) or np.any(q > upper):
            return "a position limit is broken"
        moved = np.abs(np.diff(np.vstack([START, q]), axis=0)).max(axis=0)
        return "a speed limit is broken" if np.any(moved > speeds * dt * (1.0 + 1e-9)) else ""
