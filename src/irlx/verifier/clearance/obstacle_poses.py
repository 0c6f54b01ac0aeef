"""Where obstacles lie at the times of rows."""

from __future__ import annotations

import numpy as np

from irlx.scene.obstacle import Obstacle
from irlx.solids.placement import Placement
from irlx.streams.joint_stream import Floats
from irlx.verifier.geometry.link_poses import Poses
from irlx.verifier.geometry.rotations import from_quaternion, rotation_vectors


def pose_of(placement: Placement) -> tuple[Floats, Floats]:
    """Position (3,) m and rotation (3, 3) of a placement."""
    quaternion = np.array(placement.orientation)
    return np.array(placement.position), from_quaternion(quaternion / np.linalg.norm(quaternion))


def obstacle_poses(obstacle: Obstacle, times: Floats) -> Poses:
    """Poses of an obstacle in the world at times (N,) s; one for all where it rests.

    Between two waypoints the position goes straight and evenly, the orientation evenly about one axis, the
    shortest way; before the first and behind the last one it rests there.
    """
    if not obstacle.trajectory:
        position, rotation = pose_of(obstacle.placement)
        return position[None], rotation[None]
    poses = [pose_of(waypoint.placement) for waypoint in obstacle.trajectory]
    positions, rotations = (np.stack(part) for part in zip(*poses, strict=True))
    due = np.array([waypoint.time for waypoint in obstacle.trajectory])
    if len(due) == 1:
        return positions, rotations
    before = np.clip(np.searchsorted(due, times, side="right") - 1, 0, len(due) - 2)
    share = np.clip((times - due[before]) / np.diff(due)[before], 0.0, 1.0)
    way = np.diff(positions, axis=0)
    turns = rotation_vectors(np.swapaxes(rotations[:-1], 1, 2) @ rotations[1:])
    return positions[before] + share[:, None] * way[before], rotations[before] @ _turned(turns[before], share)


def _turned(turns: Floats, share: Floats) -> Floats:
    """Rotations (N, 3, 3) by shares (N,) of rotation vectors (N, 3)."""
    angles = np.linalg.norm(turns, axis=1)
    axes = np.divide(turns, angles[:, None], out=np.zeros_like(turns), where=angles[:, None] > 0.0)
    x, y, z = axes.T
    none = np.zeros_like(x)
    rows = [[none, -z, y], [z, none, -x], [-y, x, none]]
    cross = np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
    half = np.sin(0.5 * angles * share)
    sine, versine = np.sin(angles * share)[:, None, None], (2.0 * half * half)[:, None, None]
    return np.asarray(np.eye(3) + sine * cross + versine * (cross @ cross))
