"""What a motion keeps clear of: the obstacles that are switched on, and the robot's own links."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property

from irlx.pacing.options import Options
from irlx.robot.kinematics import Kinematics
from irlx.scene.distances import Distances
from irlx.scene.obstacle import Obstacle
from irlx.scene.scene import LinkClearance, Scene
from irlx.scene.watched_pair import watched_pairs
from irlx.transform.clearance import Clearance


class KeptClear:
    """What must not come near while some options are in force.

    Made ready when it is first asked for: many obstacles may be switched on one after another before anything
    moves.
    """

    def __init__(self, kinematics: Kinematics, scene: Scene, options: Options) -> None:
        self._kinematics, self._scene, self._options = kinematics, scene, options

    @cached_property
    def clearance(self) -> Clearance | None:
        """From all that is switched on, and of links from each other; None where nothing must not come near.

        An obstacle counts once, however many of the names that are on stand for it.
        """
        obstacles = {
            obstacle.name: obstacle
            for switch in self._options.obstacles.values()
            for obstacle in self._scene.members(switch.name)
        }
        return self._from(obstacles.values(), self._scene.links)

    def clearance_from(self, obstacles: Iterable[Obstacle]) -> Clearance | None:
        """From some obstacles alone, made ready anew."""
        return self._from(obstacles, None)

    def _from(self, obstacles: Iterable[Obstacle], links: LinkClearance | None) -> Clearance | None:
        pairs = watched_pairs(self._kinematics, obstacles, links)
        return Clearance(Distances(self._kinematics, pairs, self._scene.sightings)) if pairs else None
