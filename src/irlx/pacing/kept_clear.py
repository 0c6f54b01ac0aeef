"""What a motion keeps clear of: the obstacles that are switched on, and the robot's own links."""

from __future__ import annotations

from irlx.pacing.options import Options
from irlx.robot.kinematics import Kinematics
from irlx.scene.distances import Distances
from irlx.scene.scene import Scene
from irlx.scene.watched_pair import watched_pairs
from irlx.transform.clearance import Clearance


def kept_clear(kinematics: Kinematics, scene: Scene, options: Options) -> Clearance | None:
    """What must not come near while these options are in force; None where nothing must not.

    An obstacle counts once, however many of the names that are on stand for it.
    """
    obstacles = {
        obstacle.name: obstacle
        for switch in options.obstacles.values()
        for obstacle in scene.members(switch.name)
    }
    pairs = watched_pairs(kinematics, obstacles.values(), scene.links)
    return Clearance(Distances(kinematics, pairs, scene.sightings)) if pairs else None
