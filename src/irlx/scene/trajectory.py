"""Where an obstacle that moves lies, and how fast its points are."""

from __future__ import annotations

from itertools import pairwise
from typing import Protocol

import numpy as np
import pinocchio as pin

from irlx.scene.collision_shape import pose_of
from irlx.scene.obstacle import Obstacle


class Way(Protocol):
    """Where something is at a time."""

    def pose(self, time: float) -> pin.SE3:
        """Pose of its frame in the world at a time (s)."""


class Resting:
    """The way of an obstacle that stays where it is."""

    def __init__(self, obstacle: Obstacle) -> None:
        self._pose = pose_of(obstacle.placement)

    def pose(self, time: float) -> pin.SE3:
        """Pose of the obstacle's frame, the same at any time (s)."""
        return self._pose


class Trajectory:
    """The way of an obstacle in the world.

    Between two waypoints its frame goes straight and turns about one axis, both evenly; outside of them it
    rests at the nearer one.
    """

    def __init__(self, obstacle: Obstacle) -> None:
        self._times = np.array([point.time for point in obstacle.trajectory])
        self._poses = [pose_of(point.placement) for point in obstacle.trajectory]

    def pose(self, time: float) -> pin.SE3:
        """Pose of the obstacle's frame at a time (s)."""
        k = int(np.searchsorted(self._times, time, side="right")) - 1
        if k < 0 or k == len(self._times) - 1:
            return self._poses[max(k, 0)]
        before, behind = self._poses[k], self._poses[k + 1]
        share = (time - self._times[k]) / (self._times[k + 1] - self._times[k])
        turn = pin.log3(before.rotation.T @ behind.rotation)
        place = before.translation + share * (behind.translation - before.translation)
        return pin.SE3(before.rotation @ pin.exp3(share * turn), place)

    def fastest(self, radius: float) -> float:
        """Largest speed (m/s) of its points within `radius` (m, or infinite) of its frame's origin."""
        found = [0.0]
        for (t0, before), (t1, behind) in pairwise(zip(self._times, self._poses, strict=True)):
            way = float(np.linalg.norm(behind.translation - before.translation))
            turn = float(np.linalg.norm(pin.log3(before.rotation.T @ behind.rotation)))
            # Of a half-space that only goes straight no point is any faster than the others.
            found.append((way + (turn * radius if turn > 0.0 else 0.0)) / float(t1 - t0))
        return max(found)


def way_of(obstacle: Obstacle) -> Way:
    """The way that the cell says an obstacle goes."""
    return Trajectory(obstacle) if obstacle.trajectory else Resting(obstacle)
