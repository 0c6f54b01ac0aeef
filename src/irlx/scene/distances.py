"""How far a robot is from what it keeps clear of, by coal through Pinocchio."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import coal
import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics
from irlx.scene.collision_shape import bounding_radius, collision_shape, pose_of
from irlx.scene.levers import Levers
from irlx.scene.sightings import Sightings
from irlx.scene.trajectory import Resting, Trajectory, Way
from irlx.scene.watched_pair import WatchedPair
from irlx.solids.shape import Solid

Array = NDArray[np.float64]
Numbers = NDArray[np.intp]

_TOLERANCE = 1e-9
"""What the search for nearest points may leave (m)."""

_COARSER = (1e-8, 1e-7, 1e-6, 1e-5)
"""The same where solids overlap and the search gives up at less."""

_ENDLESS = 1e100
_CROSS = np.zeros((3, 9))
"""A point times this is the matrix, row by row, that turns an angular velocity into the point's velocity."""
_CROSS[0, [5, 7]] = 1.0, -1.0
_CROSS[1, [2, 6]] = -1.0, 1.0
_CROSS[2, [1, 3]] = 1.0, -1.0


class Near(NamedTuple):
    """Pairs that are near in a posture, P of them, by their numbers `pairs` (P,).

    `distance` (P,) m, negative where they overlap; `away` (P, 3) unit vectors in the world along which the
    link leaves the other one; the nearest points `on_link` and `on_other` (P, 3) m in the world.
    """

    pairs: Numbers
    distance: Array
    away: Array
    on_link: Array
    on_other: Array

    def chosen(self, which: NDArray[np.bool_]) -> Near:
        """Those of the pairs (P,) that are True."""
        points = self.on_link[which], self.on_other[which]
        return Near(self.pairs[which], self.distance[which], self.away[which], *points)


class Known(NamedTuple):
    """Bounds `least` (K,), m, of the distances of all pairs at posture `at` (n,)."""

    at: Array
    least: Array


_NOTHING_NEAR = Near(np.zeros(0, dtype=np.intp), np.zeros(0), *np.zeros((3, 0, 3)))


@dataclass
class _Placed:
    """A solid of an obstacle that moves or may be seen: its number, pose in the obstacle, radius (m).

    `pose` is where the obstacle's frame is in the world now.
    """

    number: int
    name: str
    within: pin.SE3
    radius: float
    way: Way
    pose: pin.SE3


class Distances:
    """Distances between watched pairs of solids, obstacles where their trajectories or `sightings` put them.

    A pair is looked at again only where the joints have moved far enough since it was looked at last
    (`Levers`), or the obstacle, and once in a posture; what is found does not depend on that. Postures must
    not be written to once they have been handed in. Not safe for use by several threads at once.
    """

    def __init__(
        self, kinematics: Kinematics, pairs: Sequence[WatchedPair], sightings: Sightings | None = None
    ) -> None:
        self.kinematics = kinematics
        self.pairs = tuple(pairs)
        self.margin = np.array([pair.margin for pair in pairs])
        self.influence = np.array([pair.influence for pair in pairs])
        self._model = pin.GeometryModel()
        self._numbers: dict[tuple[str, bool, int], int] = {}
        self._bodies: list[int] = []
        self._radii: list[float] = []
        self._sizes: list[float] = []
        self._sightings = sightings
        self._count, self._before = 0, False
        self._placed: list[_Placed] = []
        self._speeds: list[float] = []
        self._first = np.array([self._add_of_link(p.link, p.solid) for p in pairs], dtype=np.intp)
        self._second = np.array([self._add_other(p) for p in pairs], dtype=np.intp)
        for first, second in zip(self._first, self._second, strict=True):
            self._model.addCollisionPair(pin.CollisionPair(int(first), int(second)))
        self._geometry = pin.GeometryData(self._model)
        self._requests = self._geometry.distanceRequests
        for number in range(len(pairs)):
            self._requests[number] = _request()
        self._data = kinematics.model.createData()
        self._levers = Levers.of(kinematics, self._bodies, self._radii, self._first, self._second)
        self._last = np.zeros(kinematics.joints)
        self._least = np.full(len(pairs), -np.inf)
        self._slack = -np.inf
        self._longest = self._levers.longest
        self._far_at: Array | None = None
        self._here: Array | None = None
        sizes = np.array(self._sizes)
        # Half-spaces have no size; what they give is taken for as long as it is a distance at all.
        deepest = -(sizes[self._first] + sizes[self._second]) if len(pairs) else np.zeros(0)
        self._deepest = np.where(np.isfinite(deepest), deepest, -_ENDLESS)
        self._known = np.zeros(len(pairs), dtype=np.bool_)
        self._found = np.empty((len(pairs), 10))
        self._all_near: Near | None = None
        self._columns: Array = self._data.J
        carries = np.zeros((kinematics.model.njoints, kinematics.model.nv))
        for joint in range(1, kinematics.model.njoints):
            carries[joint, [above - 1 for above in kinematics.model.supports[joint] if above]] = 1.0
        bodies = np.array(self._bodies, dtype=np.intp)
        self._first_carried = carries[bodies[self._first], None] if len(pairs) else carries[:0, None]
        self._second_carried = carries[bodies[self._second], None] if len(pairs) else carries[:0, None]
        self._others_rest = not np.any(self._second_carried)
        self._time = self._looked_at = 0.0
        self._rates = np.array([self._speeds[k] for k in self._second])
        self._fastest = float(np.max(self._rates, initial=0.0))
        self.at_time(0.0)

    def at_time(self, time: float, before: bool = False) -> None:
        """Put obstacles that move where they are at a `time` (s) of the run, and those seen where they are.

        `before`: those that are seen where they were before the tick that goes on.
        """
        seen = self._sightings
        count = 0 if seen is None else seen.count
        if not self._placed or (time, count, before) == (self._time, self._count, self._before):
            return
        self._time, self._count, self._before = time, count, before
        self._all_near = self._far_at = None
        for placed in self._placed:
            way, name = placed.way, placed.name
            pose = way.pose(time) if seen is None else seen.pose(name, time, way, before)
            if pose is placed.pose:
                continue
            if seen is not None and seen.known(placed.name):
                self._jumped(placed, pose)
            self._here, placed.pose = None, pose
            self._model.geometryObjects[placed.number].placement = pose * placed.within

    def _jumped(self, placed: _Placed, pose: pin.SE3) -> None:
        """Make what is known of the pairs of a solid less by the most that it may have come nearer."""
        way = float(np.linalg.norm(pose.translation - placed.pose.translation))
        turn = float(np.linalg.norm(pin.log3(placed.pose.rotation.T @ pose.rotation)))
        if turn > 0.0:
            way += turn * placed.radius
        if self._speeds[placed.number] > 0.0:
            # On its own way it was somewhere else when it was looked at.
            way = np.inf
        self._least = self._least - np.where(self._second == placed.number, way, 0.0)
        self._slack -= way

    @property
    def moves(self) -> bool:
        """Whether any obstacle moves by itself; one that is seen rests, for all that is known."""
        seen = self._sightings
        return any(
            self._speeds[placed.number] > 0.0 and not (seen and seen.known(placed.name))
            for placed in self._placed
        )

    @property
    def seen(self) -> NDArray[np.bool_]:
        """The pairs (K,) whose obstacle somebody sees."""
        seen = self._sightings
        return np.array(
            [bool(seen and pair.obstacle is not None and seen.known(pair.other)) for pair in self.pairs],
            dtype=bool,
        )

    def far(self, q: Array) -> bool:
        """Whether it is certain without a look that no pair is within its influence at posture q (n,)."""
        if q is self._far_at:
            return True
        if self._slack <= 0.0:
            return False
        if self._longest is None:
            return self._fastest == 0.0 and self.clear_rows(q[None], self.influence) == 1
        moved = self._longest.dot(np.abs(q - self._last))
        if self._fastest > 0.0 and self._time != self._looked_at:
            moved += self._fastest * abs(self._time - self._looked_at)
        if not moved < self._slack:
            return False
        # The end of a tick, which the next one begins with.
        self._far_at = q
        return True

    def clear_rows(self, q: Array, within: Array) -> int:
        """How many of the first of postures q (N, n) surely have no pair nearer than `within` (K,) m.

        Without a look, and for obstacles that are where they were at the last one.
        """
        sure = np.all(self._least - self._levers.moved(self._last, q) >= within, axis=1)
        return len(q) if np.all(sure) else int(np.argmin(sure))

    @property
    def known(self) -> Known:
        """What the looks so far tell."""
        return Known(self._last, self._least)

    def surely_clear(self, q: Array, before: Known, within: Array) -> int:
        """How many of the first of postures q (N, n) surely have no pair nearer than `within` (K,) m, by what
        was known `before` and by the last look; none where obstacles move."""
        if self._fastest > 0.0:
            return 0
        first = before.least - self._levers.moved(before.at, q)
        least = np.maximum(first, self._least - self._levers.moved(self._last, q))
        sure = np.all(least >= within, axis=1)
        return len(q) if np.all(sure) else int(np.argmin(sure))

    def keeps_between(self, q: Array, room: Array) -> bool:
        """Whether no pair loses more than its `room` (K,) m half way from one row of q (N, n) to the next."""
        return bool(np.all(0.5 * self._levers.moved(q[:-1], q[1:]) <= room))

    def near(self, q: Array, within: Array | None = None) -> Near:
        """Pairs nearer than `within` (K,) m, by default their influence, at posture q (n,)."""
        everything = within is None
        if everything and self._all_near is not None and _same(q, self._last):
            return self._all_near
        reach = self.influence if within is None else within
        moved = self._levers.moved(self._last, q)
        least = self._least - moved
        if self._fastest > 0.0 and self._time != self._looked_at:
            least = least - self._rates * abs(self._time - self._looked_at)
        asked = (least < reach).nonzero()[0]
        if not len(asked) and not everything:
            # Sure as it is: the last look goes on to count.
            return _NOTHING_NEAR
        self._looked_at = self._time
        if len(asked) > 1:
            asked = self._close(q, asked, reach, least, moved)
        found = self.of(q, asked)
        least[asked] = found.distance
        self._least, self._last = least, q.copy()
        close = found.distance < reach[asked]
        count = np.count_nonzero(close)
        some_near = everything and count > 0
        self._slack = -np.inf if some_near else float((least - self.influence).min(initial=np.inf))
        if count == 0:
            found = _NOTHING_NEAR
        elif count < len(asked):
            found = found.chosen(close)
        self._all_near = found if everything else None
        return found

    def of(self, q: Array, pairs: Numbers) -> Near:
        """These pairs at posture q (n,), however far."""
        if not len(pairs):
            return _NOTHING_NEAR
        self._place(q)
        known = self._known[pairs]
        unknown = len(pairs) - np.count_nonzero(known)
        if unknown:
            self._look(pairs if unknown == len(pairs) else pairs[~known])
        found = self._found[pairs]
        return Near(pairs, found[:, 0], -found[:, 1:4], found[:, 4:7], found[:, 7:])

    def _close(self, q: Array, pairs: Numbers, reach: Array, least: Array, moved: Array) -> Numbers:
        """Those of `pairs` that the spheres about their solids do not tell apart by more than `reach` (K,) m.

        What they tell is put into `least` (K,). A look is worth more: pairs that it may spare the next one
        after a way as long as the last one, by which they have `moved` (K,) m, but the spheres do not, stay.
        """
        self._place(q)
        middles = np.array([place.translation for place in self._geometry.oMg])
        ways = middles[self._first[pairs]] - middles[self._second[pairs]]
        apart = np.sqrt(np.einsum("ki,ki->k", ways, ways))
        spheres = apart + self._deepest[pairs]
        further = moved[pairs] + reach[pairs]
        known = (spheres >= reach[pairs]) & ((spheres > further) | (apart < further))
        least[pairs[known]] = spheres[known]
        return np.asarray(pairs[~known])

    def _look(self, pairs: Numbers) -> None:
        """Distance, unit vector from the link to the other one and nearest points of pairs."""
        found = self._search(pairs.tolist())
        self._found[pairs] = found
        good = found[:, 0] >= self._deepest[pairs]
        if np.count_nonzero(good) < len(pairs):
            for pair in pairs[~good].tolist():
                self._search_coarsely(pair, self._found[pair])
        self._known[pairs] = True

    def _search(self, pairs: list[int]) -> Array:
        model, geometry = self._model, self._geometry
        parts: list[Any] = []
        for pair in pairs:
            result = pin.computeDistance(model, geometry, pair)
            parts += (
                (result.min_distance,),
                result.normal,
                result.getNearestPoint1(),
                result.getNearestPoint2(),
            )
        return np.concatenate(parts).reshape(-1, 10)

    def _search_coarsely(self, pair: int, found: Array) -> None:
        """How deep an overlap is, where rounding ends the search at the usual tolerance without a result."""
        request = self._requests[pair]
        for request.epa_tolerance in _COARSER:
            found[:] = self._search([pair])[0]
            if found[0] >= self._deepest[pair]:
                break
        else:
            self._mend(pair, found)
        request.epa_tolerance = _TOLERANCE

    def _mend(self, pair: int, found: Array) -> None:
        """What solids that overlap are to each other where the search has ended at what they cannot be.

        Deep inside each other it may. Then the spheres about both solids count, or the half-space, with
        their middles as nearest points.
        """
        first, second = int(self._first[pair]), int(self._second[pair])
        link, other = self._geometry.oMg[first], self._geometry.oMg[second]
        way = link.translation - other.translation
        length, size = float(np.linalg.norm(way)), self._sizes[second]
        if np.isfinite(size):
            away = way / length if length > 0.0 else np.array([0.0, 0.0, 1.0])
        else:
            away, size = other.rotation[:, 2], 0.0
        found[0] = min(float(way.dot(away)) - size - self._sizes[first], 0.0)
        found[1:4], found[4:7], found[7:] = -away, link.translation, other.translation

    def jacobians(self, q: Array, near: Near) -> Array:
        """d(point on link - point on other)/dq (P, 3, n), both points fixed on their bodies, at posture q."""
        if not len(near.pairs):
            return np.zeros((0, 3, q.size))
        self._place(q)
        found = self._point_jacobians(self._first_carried[near.pairs], near.on_link)
        if not self._others_rest:
            found -= self._point_jacobians(self._second_carried[near.pairs], near.on_other)
        return found

    def rates(self, q: Array, near: Near) -> Array:
        """d(distance)/dq (P, n) at posture q: the same along `away`."""
        if not len(near.pairs):
            return np.zeros((0, q.size))
        return np.asarray(np.matmul(near.away[:, None, :], self.jacobians(q, near))[:, 0, :])

    def _point_jacobians(self, carried: Array, points: Array) -> Array:
        """Jacobians (P, 3, n) of points (P, 3) in the world, each on a body; `carried` (P, 1, n) by which."""
        turned = points.dot(_CROSS).reshape(-1, 3)
        found = turned.dot(self._columns[3:]).reshape(-1, 3, self._columns.shape[1])
        found += self._columns[:3]
        found *= carried
        return self.kinematics.by_axes(np.asarray(found))

    def _place(self, q: Array) -> None:
        if self._here is not None and _same(q, self._here):
            return
        pin.computeJointJacobians(self.kinematics.model, self._data, self.kinematics.expanded(q))
        pin.updateGeometryPlacements(self.kinematics.model, self._data, self._model, self._geometry)
        self._columns = self._data.J
        self._here = q.copy()
        self._known[:] = False

    # ---- building

    def _add_of_link(self, link: str, solid: Solid) -> int:
        key = link, True, id(solid)
        if key in self._numbers:
            return self._numbers[key]
        joint, frame = self.kinematics.body_of(link)
        return self._add(key, joint, frame * pose_of(solid.placement), solid)

    def _add_other(self, pair: WatchedPair) -> int:
        if pair.obstacle is None:
            return self._add_of_link(pair.other, pair.other_solid)
        key = pair.other, False, id(pair.other_solid)
        if key in self._numbers:
            return self._numbers[key]
        within = pose_of(pair.other_solid.placement)
        world = pose_of(pair.obstacle.placement) * within
        number = self._add(key, 0, world, pair.other_solid)
        trajectory = Trajectory(pair.obstacle) if pair.obstacle.trajectory else None
        if trajectory or self._sightings is not None:
            radius = float(np.linalg.norm(within.translation)) + bounding_radius(pair.other_solid.shape)
            way: Way = trajectory or Resting(pair.obstacle)
            begun = way.pose(0.0)
            self._speeds[number] = trajectory.fastest(radius) if trajectory else 0.0
            self._model.geometryObjects[number].placement = begun * within
            self._placed.append(_Placed(number, pair.obstacle.name, within, radius, way, begun))
        return number

    def _add(self, key: tuple[str, bool, int], joint: int, pose: pin.SE3, solid: Solid) -> int:
        shape: Any = collision_shape(solid.shape)
        name = f"solid {len(self._numbers)}"
        number = int(self._model.addGeometryObject(pin.GeometryObject(name, joint, pose, shape)))
        self._numbers[key] = number
        self._bodies.append(joint)
        self._speeds.append(0.0)
        size = bounding_radius(solid.shape)
        self._radii.append(float(np.linalg.norm(pose.translation)) + size)
        self._sizes.append(size)
        return number


def _request() -> coal.DistanceRequest:
    """How a pair is searched. No search begins where the last one ended, as Pinocchio's own requests ask for:
    bits would depend on what was asked before."""
    request = coal.DistanceRequest()
    request.gjk_tolerance = request.epa_tolerance = _TOLERANCE
    return request


def _same(first: Array, second: Array) -> bool:
    return first is second or first.tobytes() == second.tobytes()
