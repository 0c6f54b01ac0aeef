"""Which solids are kept off each other, and where the solids of one pair lie to each other in rows."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from irlx.robot.description import RobotDescription
from irlx.scene.obstacle import Obstacle
from irlx.scene.scene import Scene
from irlx.solids.shape import Solid
from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.clearance.obstacle_poses import obstacle_poses, pose_of
from irlx.verifier.distances.body import Body, HalfspaceBody, SolidBody, body_of
from irlx.verifier.distances.placed import onward
from irlx.verifier.geometry.link_poses import Poses, link_poses, moved_links


@dataclass(frozen=True, eq=False)
class Part:
    """A body of a link or an obstacle, and where it lies in its owner's frame: (3,) m, (3, 3)."""

    body: Body
    position: Floats
    rotation: Floats


@dataclass(frozen=True, eq=False)
class Pair:
    """A link and what it is kept `margin` (m) away from: an obstacle, or a link where `obstacle` is None."""

    link: str
    other: str
    margin: float
    obstacle: Obstacle | None
    parts: tuple[Part, ...]
    other_parts: tuple[Part, ...]

    @property
    def name(self) -> str:
        """The pair in words."""
        return f"{self.link} and {self.other}"


class Bodies:
    """Bodies of solids, each made once."""

    def __init__(self) -> None:
        self._known: dict[Solid, Part] = {}

    def parts(self, solids: tuple[Solid, ...]) -> tuple[Part, ...]:
        """The parts that solids make. Raises ValueError where a shape or its file is not usable."""
        for solid in solids:
            if solid not in self._known:
                self._known[solid] = Part(body_of(solid.shape), *pose_of(solid.placement))
        return tuple(self._known[solid] for solid in solids)


def obstacle_pairs(robot: RobotDescription, obstacle: Obstacle, bodies: Bodies) -> tuple[Pair, ...]:
    """Every link with an obstacle; of links that no axis moves only those that a moving obstacle may meet."""
    moved = moved_links(robot)
    others = bodies.parts(obstacle.solids)
    return tuple(
        Pair(link, obstacle.name, obstacle.margin, obstacle, bodies.parts(solids), others)
        for link, solids in robot.solids.items()
        if solids and (link in moved or obstacle.trajectory)
    )


def link_pairs(robot: RobotDescription, scene: Scene, bodies: Bodies) -> tuple[Pair, ...]:
    """The links of a scene that are kept off each other."""
    if scene.links is None:
        return ()
    solids, margin = robot.solids, scene.links.margin
    return tuple(
        Pair(link, other, margin, None, bodies.parts(solids[link]), bodies.parts(solids[other]))
        for link, other in scene.links.pairs
        if solids.get(link) and solids.get(other)
    )


class Places:
    """Poses of all that pairs consist of in K rows with joint values q (K, n) at `times` (K,) s."""

    def __init__(self, robot: RobotDescription, q: Floats, times: Floats) -> None:
        self._robot, self._q, self._times = robot, q, times
        self._obstacles: dict[str, Poses] = {}

    def __len__(self) -> int:
        return len(self._q)

    @cached_property
    def _links(self) -> dict[str, Poses]:
        return link_poses(self._robot, self._q, tuple(self._robot.solids))

    def of_other(self, pair: Pair) -> Poses:
        """Poses of what a link is kept away from, in the world."""
        if pair.obstacle is None:
            return self._links[pair.other]
        if pair.other not in self._obstacles:
            self._obstacles[pair.other] = obstacle_poses(pair.obstacle, self._times)
        return self._obstacles[pair.other]

    def of_link(self, pair: Pair) -> Poses:
        """Poses of a pair's link in the world."""
        return self._links[pair.link]


@dataclass(frozen=True, eq=False)
class Meeting:
    """One solid of an obstacle or link, at rest, and one of another link that moves about it in K rows."""

    first: Body
    second: SolidBody
    centres: Floats
    poses: Callable[[Integers], Poses]

    @cached_property
    def least(self) -> Floats:
        """At most the distances (K,), m, by a ball around the second body."""
        return np.asarray(self.first.from_points(self.centres) - self.second.reach)

    def at(self, rows: Integers) -> Poses:
        """Poses of the second body in the frame of the first in rows (M,) of the K."""
        return self.poses(rows)


def meetings(pair: Pair, places: Places) -> list[Meeting]:
    """All combinations of a pair's solids."""
    return [
        _meeting(other, part, places.of_other(pair), places.of_link(pair), len(places))
        for other in pair.other_parts
        for part in pair.parts
    ]


def _meeting(first: Part, second: Part, first_owner: Poses, second_owner: Poses, count: int) -> Meeting:
    if isinstance(second.body, HalfspaceBody):
        raise ValueError("a link cannot be a half-space")
    body = second.body

    def poses(rows: Integers) -> Poses:
        one, other = _placed(first, first_owner, rows), _placed(second, second_owner, rows)
        back = np.swapaxes(one[1], 1, 2)
        return onward(back, other[0] - one[0]), np.asarray(back @ other[1])

    centre = second.position + second.rotation @ body.centre
    from_owner = second_owner[0] + _turned(second_owner[1], centre) - first_owner[0]
    if len(first_owner[1]) == 1:
        from_owner = from_owner @ first_owner[1][0]
    else:
        from_owner = np.einsum("kji,kj->ki", first_owner[1], np.broadcast_to(from_owner, (count, 3)))
    centres = (from_owner - first.position) @ first.rotation
    return Meeting(first.body, body, np.broadcast_to(centres, (count, 3)), poses)


def _turned(rotations: Floats, vector: Floats) -> Floats:
    """Products (N, 3) of a stack and one vector: one tall product is far quicker than N small ones."""
    return np.asarray((rotations.reshape(-1, 3) @ vector).reshape(-1, 3))


def _placed(part: Part, owner: Poses, rows: Integers) -> Poses:
    """Poses of a part in the world, in rows of its owner's."""
    positions, rotations = owner
    if len(positions) > 1:
        positions, rotations = positions[rows], rotations[rows]
    placed = positions + _turned(rotations, part.position), rotations @ part.rotation
    if len(positions) != len(rows):
        return np.repeat(placed[0], len(rows), axis=0), np.repeat(placed[1], len(rows), axis=0)
    return placed
