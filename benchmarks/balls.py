"""Balls as obstacles of an arm: far away, or so near its line that it feels them."""

from __future__ import annotations

import numpy as np

from chains import Arm, Walked
from irlx.scene.distances import Distances
from irlx.scene.obstacle import Obstacle
from irlx.scene.watched_pair import watched_pairs
from irlx.solids.placement import Placement
from irlx.solids.shape import Solid, Sphere


def ball(number: int, position: np.ndarray) -> Obstacle:
    """A ball of 50 mm, felt from 300 mm on."""
    place = Placement(tuple(float(x) for x in position))
    return Obstacle(f"ball{number}", (Solid(Sphere(0.05)),), place, 0.01, 0.3)


def far(count: int) -> list[Obstacle]:
    """Balls 3 m around the robot."""
    away = np.random.default_rng(0).normal(size=(count, 3))
    away *= 3.0 / np.linalg.norm(away, axis=1, keepdims=True)
    return [ball(number, position) for number, position in enumerate(away)]


def felt(arm: Arm, free: Walked, count: int) -> list[Obstacle]:
    """Balls whose surface is never nearer than 150 mm on the free line, and once nearer than 250 mm."""
    drawn = np.random.default_rng(0).uniform((-0.6, -0.6, 0.2), (0.9, 0.6, 1.4), (16 * count + 60, 3))
    balls = [ball(number, position) for number, position in enumerate(drawn)]
    pairs = watched_pairs(arm.kinematics, balls, None)
    distances = Distances(arm.kinematics, pairs)
    postures = free.rows[0].q[::250]
    found = np.array([distances.of(q, np.arange(len(pairs))).distance for q in postures])
    nearest: dict[str, float] = {}
    for pair, distance in zip(pairs, found.min(axis=0).tolist(), strict=True):
        nearest[pair.obstacle.name] = min(distance, nearest.get(pair.obstacle.name, np.inf))
    chosen = [one for one in balls if 0.15 < nearest[one.name] < 0.25]
    if len(chosen) < count:
        raise SystemExit("too few balls are felt")
    return chosen[:count]
