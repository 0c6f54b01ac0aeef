"""How far a robot is from what it keeps clear of, by coal through Pinocchio."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

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

_GUESS = np.array([1.0, 0.0, 0.0])
_FIRST_VERTICES = np.zeros(2, dtype=np.int32)
_WORLD = pin.ReferenceFrame.WORLD


@dataclass(frozen=True)
class Near:
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
    (`Levers`), or the obstacle; what is found does not depend on that. Not safe for use by several threads
    at once.
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
        self._sightings = sightings
        self._count, self._before = 0, False
        self._placed: list[_Placed] = []
        self._speeds: list[float] = []
        self._first = np.array([self._add_of_link(p.link, p.solid) for p in pairs], dtype=np.intp)
        self._second = np.array([self._add_other(p) for p in pairs], dtype=np.intp)
        for first, second in zip(self._first, self._second, strict=True):
            self._model.addCollisionPair(pin.CollisionPair(int(first), int(second)))
        self._geometry = pin.GeometryData(self._model)
        self._requests = list(self._geometry.distanceRequests)
        for request in self._requests:
            request.gjk_tolerance = request.epa_tolerance = _TOLERANCE
        self._data = kinematics.model.createData()
        self._levers = Levers.of(kinematics, self._bodies, self._radii, self._first, self._second)
        self._last = np.zeros(kinematics.joints)
        self._least = np.full(len(pairs), -np.inf)
        self._slack = -np.inf
        self._longest = self._levers.longest
        self._here: Array | None = None
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
        if self._slack <= 0.0 or self._longest is None:
            return False
        moved = self._longest.dot(np.abs(q - self._last))
        if self._fastest > 0.0:
            moved += self._fastest * abs(self._time - self._looked_at)
        return bool(moved < self._slack)

    def near(self, q: Array, within: Array | None = None) -> Near:
        """Pairs nearer than `within` (K,) m, by default their influence, at posture q (n,)."""
        reach = self.influence if within is None else within
        least = self._least - self._levers.moved(self._last, q)
        if self._fastest > 0.0:
            least = least - self._rates * abs(self._time - self._looked_at)
            self._looked_at = self._time
        asked = np.flatnonzero(least < reach)
        found = self.of(q, asked)
        least[asked] = found.distance
        self._least, self._last = least, q.copy()
        self._slack = float(np.min(least - self.influence, initial=np.inf))
        close = found.distance < reach[asked]
        return found if np.all(close) else found.chosen(close)

    def of(self, q: Array, pairs: Numbers) -> Near:
        """These pairs at posture q (n,), however far."""
        count = len(pairs)
        distance, away = np.empty(count), np.empty((count, 3))
        on_link, on_other = np.empty((count, 3)), np.empty((count, 3))
        if count:
            self._place(q)
        for k, pair in enumerate(pairs.tolist()):
            # Pinocchio begins where the last search ended: bits would depend on what was asked before.
            request = self._requests[pair]
            request.cached_gjk_guess, request.cached_support_func_guess = _GUESS, _FIRST_VERTICES
            result = pin.computeDistance(self._model, self._geometry, pair)
            distance[k], away[k] = result.min_distance, -result.normal
            on_link[k], on_other[k] = result.getNearestPoint1(), result.getNearestPoint2()
        return Near(pairs, distance, away, on_link, on_other)

    def jacobians(self, q: Array, near: Near) -> Array:
        """d(point on link - point on other)/dq (P, 3, n), both points fixed on their bodies, at posture q."""
        found = np.empty((len(near.pairs), 3, q.size))
        if len(near.pairs):
            self._place(q)
        for k, pair in enumerate(near.pairs.tolist()):
            found[k] = self._point_jacobian(self._bodies[self._first[pair]], near.on_link[k])
            second = self._bodies[self._second[pair]]
            if second:
                found[k] -= self._point_jacobian(second, near.on_other[k])
        return found

    def _point_jacobian(self, joint: int, point: Array) -> Array:
        if joint == 0:
            return np.zeros((3, self.kinematics.joints))
        whole = pin.getJointJacobian(self.kinematics.model, self._data, joint, _WORLD)
        x, y, z = point.tolist()
        turned = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
        return np.asarray(whole[:3] + turned @ whole[3:])

    def _place(self, q: Array) -> None:
        if self._here is not None and np.array_equal(q, self._here):
            return
        pin.computeJointJacobians(self.kinematics.model, self._data, q)
        pin.updateGeometryPlacements(self.kinematics.model, self._data, self._model, self._geometry)
        self._here = q.copy()

    # ---- building

    def _add_of_link(self, link: str, solid: Solid) -> int:
        joint, frame = self.kinematics.body_of(link)
        return self._add(("link", True, id(solid)), joint, frame * pose_of(solid.placement), solid)

    def _add_other(self, pair: WatchedPair) -> int:
        if pair.obstacle is None:
            return self._add_of_link(pair.other, pair.other_solid)
        within = pose_of(pair.other_solid.placement)
        world = pose_of(pair.obstacle.placement) * within
        known = len(self._numbers)
        number = self._add((pair.other, False, id(pair.other_solid)), 0, world, pair.other_solid)
        trajectory = Trajectory(pair.obstacle) if pair.obstacle.trajectory else None
        if number == known and (trajectory or self._sightings is not None):
            radius = float(np.linalg.norm(within.translation)) + bounding_radius(pair.other_solid.shape)
            way: Way = trajectory or Resting(pair.obstacle)
            begun = way.pose(0.0)
            self._speeds[number] = trajectory.fastest(radius) if trajectory else 0.0
            self._model.geometryObjects[number].placement = begun * within
            self._placed.append(_Placed(number, pair.obstacle.name, within, radius, way, begun))
        return number

    def _add(self, key: tuple[str, bool, int], joint: int, pose: pin.SE3, solid: Solid) -> int:
        number = self._numbers.get(key)
        if number is None:
            shape: Any = collision_shape(solid.shape)
            name = f"solid {len(self._numbers)}"
            number = int(self._model.addGeometryObject(pin.GeometryObject(name, joint, pose, shape)))
            self._numbers[key] = number
            self._bodies.append(joint)
            self._speeds.append(0.0)
            self._radii.append(float(np.linalg.norm(pose.translation)) + bounding_radius(solid.shape))
        return number
