"""An obstacle of the cell."""

from __future__ import annotations

from dataclasses import dataclass

from irlx.solids.placement import Placement
from irlx.solids.shape import Solid


@dataclass(frozen=True)
class Waypoint:
    """Where a moving obstacle lies at a `time` (s) of the run."""

    time: float
    placement: Placement


@dataclass(frozen=True)
class Obstacle:
    """Solids that keep their places to each other, and how far the robot stays from them.

    `placement` of its frame in the world; `margin` (m) is kept clear of the robot, from the distance
    `influence` (m) on it is felt. `trajectory`, rising in time, says where an obstacle that moves lies:
    between two waypoints on the straight way, turning about one axis; outside of them it rests.
    """

    name: str
    solids: tuple[Solid, ...]
    placement: Placement
    margin: float
    influence: float
    trajectory: tuple[Waypoint, ...] = ()
