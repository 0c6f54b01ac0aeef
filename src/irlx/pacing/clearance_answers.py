"""Answers to questions about obstacles, and what must be true of one that the robot is to keep clear of."""

from __future__ import annotations

import numpy as np

from irlx.blocks import AskClearance
from irlx.diagnostics import Place, report
from irlx.language.obstacles import unknown_obstacle
from irlx.pacing.errors import PacingError
from irlx.robot.kinematics import Kinematics
from irlx.scene.distances import Distances
from irlx.scene.obstacle import Obstacle
from irlx.scene.scene import Scene
from irlx.scene.watched_pair import WatchedPair, watched_pairs


class Clearances:
    """Distances of a robot from the obstacles and groups of a scene, each made ready when first asked for."""

    def __init__(self, kinematics: Kinematics, scene: Scene) -> None:
        self._kinematics = kinematics
        self._scene = scene
        self._ready: dict[str, Distances] = {}

    def answer(self, question: AskClearance, time: float, place: Place) -> tuple[float]:
        """The smallest distance (m) at a `time` (s) of the run, negative where solids overlap.

        Raises PacingError: IRL573, IRL574 as `pairs_of`.
        """
        key = question.name.casefold()
        if key not in self._ready:
            pairs = pairs_of(question.name, self._kinematics, self._scene, place)
            self._ready[key] = Distances(self._kinematics, pairs, self._scene.sightings)
        distances = self._ready[key]
        distances.at_time(time)
        found = distances.of(np.array(question.posture), np.arange(len(distances.pairs)))
        return (float(np.min(found.distance)),)


def pairs_of(name: str, kinematics: Kinematics, scene: Scene, place: Place) -> tuple[WatchedPair, ...]:
    """What has to stay apart for a robot to keep clear of an obstacle or group: one pair at least.

    Raises PacingError: IRL573 for a name that the scene does not have, IRL574 for a robot none of whose links
    that joints move has a shape.
    """
    pairs = watched_pairs(kinematics, _members(name, scene, place), None)
    if not pairs:
        raise PacingError(report("IRL574", place, robot=kinematics.description.name, name=name))
    return pairs


def _members(name: str, scene: Scene, place: Place) -> tuple[Obstacle, ...]:
    try:
        return scene.members(name)
    except KeyError:
        raise PacingError(unknown_obstacle(name, scene.names, place)) from None
