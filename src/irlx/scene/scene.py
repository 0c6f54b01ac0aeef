"""All obstacles of a cell, by name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from irlx.scene.obstacle import Obstacle

if TYPE_CHECKING:
    from irlx.scene.sightings import Sightings


@dataclass(frozen=True)
class LinkClearance:
    """Pairs of links that stay `margin` (m) away from each other, felt from `influence` (m) on."""

    pairs: tuple[tuple[str, str], ...]
    margin: float
    influence: float


@dataclass(frozen=True)
class Scene:
    """Obstacles and groups of them by casefolded name; `links` where links are kept off each other.

    `sightings` where somebody sees obstacles while the program runs.
    """

    obstacles: Mapping[str, Obstacle] = field(default_factory=dict)
    groups: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    links: LinkClearance | None = None
    sightings: Sightings | None = field(default=None, compare=False)

    @property
    def names(self) -> tuple[str, ...]:
        """Every name that OBSTACLE may call, as the cell writes it; groups as they are kept."""
        return (*(obstacle.name for obstacle in self.obstacles.values()), *self.groups)

    @property
    def moves(self) -> bool:
        """Whether any obstacle moves by itself, so that distances depend on the time.

        One that is seen rests where it was seen last, for all that is known.
        """
        return any(
            obstacle.trajectory and not (self.sightings and self.sightings.known(obstacle.name))
            for obstacle in self.obstacles.values()
        )

    def members(self, name: str) -> tuple[Obstacle, ...]:
        """The obstacles that a name stands for, whatever its case. Raises KeyError where none does."""
        key = name.casefold()
        return tuple(self.obstacles[member] for member in self.groups.get(key, (key,)))
