"""What must not come near what: pairs of solids."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from irlx.robot.kinematics import Kinematics
from irlx.scene.obstacle import Obstacle
from irlx.scene.scene import LinkClearance
from irlx.solids.shape import Solid


@dataclass(frozen=True)
class WatchedPair:
    """A solid of a link, and one of an obstacle or of another link.

    `other` names the obstacle or link; `margin` (m) is kept between them, from `influence` (m) on the pair
    counts. Only obstacles push: `obstacle` is None for two links.
    """

    link: str
    solid: Solid
    other: str
    other_solid: Solid
    margin: float
    influence: float
    obstacle: Obstacle | None = None

    def __str__(self) -> str:
        return f"{self.link} and {self.other}"


def watched_pairs(
    kinematics: Kinematics, obstacles: Iterable[Obstacle], links: LinkClearance | None
) -> tuple[WatchedPair, ...]:
    """Every solid of the robot with every one of the obstacles, and the solids of links kept off each other.

    Links that no joint moves are left out where the obstacle rests too.
    """
    solids = kinematics.description.solids
    pairs = [
        WatchedPair(link, solid, obstacle.name, part, obstacle.margin, obstacle.influence, obstacle)
        for obstacle in obstacles
        for link, own in solids.items()
        if kinematics.body_of(link)[0] > 0 or obstacle.trajectory
        for solid in own
        for part in obstacle.solids
    ]
    if links is not None:
        pairs += [
            WatchedPair(first, solid, second, part, links.margin, links.influence)
            for first, second in links.pairs
            for solid in solids.get(first, ())
            for part in solids.get(second, ())
        ]
    return tuple(pairs)
