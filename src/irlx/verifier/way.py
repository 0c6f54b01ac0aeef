"""What a recorded move asks of the tool: its way from the pose it starts at, its goal, its fastest rates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from irlx.blocks import ArcCourse, MoveKind, Profile
from irlx.verifier.demands import Place
from irlx.verifier.evidence import Evidence
from irlx.verifier.geometry.arcs import ArcWay, arc_shape
from irlx.verifier.geometry.paths import LineWay
from irlx.verifier.moves import MoveRows
from irlx.verifier.tools import Pose


@dataclass(frozen=True, eq=False)
class Course:
    """One move, from where it starts.

    `way` is None for a PTP, for points that make no circle, and where targets cannot be placed; then
    `goal` is None too. `speed` bounds the tool's position, m/s; `flatness` is 1/radius of an arc, in 1/m.
    """

    move: MoveRows
    way: LineWay | ArcWay | None
    goal: Pose | None
    flatness: float = 0.0

    @property
    def speed(self) -> float:
        """Fastest programmed speed of the tool, m/s: on an arc ACC bounds the normal acceleration too."""
        law = self.move.law
        return min(law.speed, float(np.sqrt(law.acc / self.flatness))) if self.flatness > 0.0 else law.speed

    @property
    def bounds(self) -> tuple[float, float]:
        """Largest speed and acceleration along the way, by s and s2: in m, or rad where the angle leads."""
        law, way = self.move.law, self.way
        if not isinstance(way, LineWay) or way.angle == 0.0:
            return self.speed, law.acc
        if way.by_angle:
            share = way.angle / way.distance if way.distance > 0.0 else np.inf
            return min(law.speed_ori, law.speed * share), min(law.acc_ori, law.acc * share)
        share = way.distance / way.angle
        return min(law.speed, law.speed_ori * share), min(law.acc, law.acc_ori * share)

    @property
    def shortest(self) -> float:
        """Shortest time from rest to rest that SPEED and ACC, or TIME, allow, s."""
        least = self.move.law.duration or 0.0
        if self.way is None:
            return least
        # As numpy's numbers, which divide by zero.
        speed, acc, length = (np.float64(value) for value in (*self.bounds, self.way.length))
        if length == 0.0:
            return least
        jerk = self.move.law.jerk if self.move.law.profile is Profile.S_CURVE and not self._by_angle else None
        if jerk is not None:
            return max(least, float(least_time(length, speed, acc, np.float64(jerk))))
        short = speed * speed >= length * acc
        return max(least, float(2.0 * np.sqrt(length / acc) if short else length / speed + speed / acc))

    @property
    def _by_angle(self) -> bool:
        return not isinstance(self.way, LineWay) or self.way.by_angle


def course_of(evidence: Evidence, move: MoveRows, start: Pose) -> Course:
    """The course of a move from a pose of the tool; where not all turns count, as that was asked for."""
    demand = evidence.demands[move.block.id]
    begins = demand.start.pose
    if evidence.placer.turns is not None and begins is not None:
        start = start[0], begins[1]
    places = evidence.placer.all_of(move, Place(start, evidence.posture(move.start)))
    poses = [place.pose for place in places if place.pose is not None]
    target = poses[-1] if poses else None
    if len(poses) < len(places) or target is None:
        return Course(move, None, None)
    if move.block.kind is MoveKind.PTP or move.block.path is not None:
        return Course(move, None, target)
    course = move.block.arc
    if course is None:
        return Course(move, LineWay(start, target, demand.allowance), target)
    return _arc(evidence, move, course, (start, poses[0], target))


def _arc(evidence: Evidence, move: MoveRows, course: ArcCourse, poses: tuple[Pose, Pose, Pose]) -> Course:
    start, via, target = poses
    shape = arc_shape(start[0], via[0], target[0], course.angle)
    if shape is None:
        return Course(move, None, target)
    goal = target if course.angle is None else (shape.end, target[1])
    found = Course(move, None, goal, shape.flatness)
    most_step = found.speed * shape.flatness * evidence.outline.header.dt
    way = ArcWay(
        shape, course, (start[1], via[1], goal[1]), most_step, evidence.demands[move.block.id].allowance
    )
    return Course(move, way, goal, shape.flatness)


def least_time(length: float, speed: float, acc: float, jerk: float) -> float:
    """Shortest time, s, from rest to rest over a length, m, under bounds of speed, acceleration and jerk.

    With the greatest speed v the acceleration lasts v/a + a/j, or, where it never gets to a, 2 sqrt(v/j).
    """
    ramp = speed / acc + acc / jerk if speed * jerk >= acc * acc else 2.0 * np.sqrt(speed / jerk)
    if length >= speed * ramp:
        return float(length / speed + ramp)
    reached = 0.5 * (np.sqrt((acc * acc / jerk) ** 2 + 4.0 * length * acc) - acc * acc / jerk)
    if reached * jerk >= acc * acc:
        return float(2.0 * (reached / acc + acc / jerk))
    return float(4.0 * np.cbrt(length / (2.0 * jerk)))
