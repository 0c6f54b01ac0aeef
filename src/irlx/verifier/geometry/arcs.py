"""Geometry of CIRCLE moves, rebuilt from their blocks: the circle through three points, the way along it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from irlx.blocks import ArcCourse
from irlx.streams.joint_stream import Floats
from irlx.verifier.geometry.allowance import EXACT, Allowance
from irlx.verifier.geometry.paths import LineWay, PathDeviation, Turn

LEAST_HEIGHT = 1e-7
"""Three points that are nearer to a line than this, m, make no circle: a tenth of what a move needs."""

WHOLE_TURN = 2.0 * np.pi

NEARLY = 1e-6
"""Angles, rad, by which rows may lie before the start of an arc or go back between ticks."""

NEAR_THE_CIRCLE = 0.5
"""Part of its radius up to which a tool may stand beside a circle for its angle to tell anything."""

SHORT_WAY = 1e-6
"""Ways shorter than this, m, come from a tiny ANGLE."""


@dataclass(frozen=True)
class ArcShape:
    """A way of `travel` rad on a circle, from `start` in the direction of `forward`.

    `start` (3,) m; `forward`, `inward` (3,) unit vectors at the start, along the way and to the centre;
    `flatness` 1/radius in 1/m; `via` rad from the start to the via point, less than a whole turn.
    """

    start: Floats
    forward: Floats
    inward: Floats
    flatness: float
    via: float
    travel: float

    def angles(self, positions: Floats) -> Floats:
        """Angle (R,) rad in -pi..pi at which the circle comes nearest to each position (R, 3).

        tan = (o . forward) / (radius - o . inward), o from the start: no large numbers on flat arcs.
        """
        offsets = positions - self.start
        height = 1.0 - self.flatness * (offsets @ self.inward)
        return np.asarray(np.arctan2(self.flatness * (offsets @ self.forward), height))

    def points(self, angles: Floats) -> Floats:
        """Positions (R, 3) m after angles (R,), rad."""
        along, rise = np.sin(angles)[:, None], 2.0 * np.sin(0.5 * angles)[:, None] ** 2
        return np.asarray(self.start + (along * self.forward + rise * self.inward) / self.flatness)

    @property
    def end(self) -> Floats:
        """Position (3,) m at the end of the way."""
        return np.asarray(self.points(np.array([self.travel]))[0])


def arc_shape(start: Floats, via: Floats, goal: Floats, angle: float | None) -> ArcShape | None:
    """Arc from start over via to goal (3,), or by `angle` rad of it; None where the points make no circle.

    The centre c solves three plane equations: half-way planes of start-via and start-goal, and the plane
    of the three points.
    """
    to_via, to_goal = via - start, goal - start
    axis = np.cross(to_via, to_goal)
    sides = [float(np.linalg.norm(side)) for side in (to_via, to_goal, goal - via)]
    area = float(np.linalg.norm(axis))
    if not area > LEAST_HEIGHT * max(sides):
        return None
    axis = axis / area
    rows = np.array([to_via / sides[0], to_goal / sides[1], axis])
    centre = np.linalg.solve(rows, np.array([0.5 * sides[0], 0.5 * sides[1], 0.0]))
    radius = float(np.linalg.norm(centre))
    inward = centre / radius
    # Start, via and goal follow each other counter-clockwise about the axis.
    shape = ArcShape(start, np.cross(inward, axis), inward, 1.0 / radius, 0.0, 0.0)
    at_via, at_goal = (float(a) % WHOLE_TURN for a in shape.angles(np.array([via, goal])))
    if angle is not None and angle < 0.0:
        return ArcShape(start, -shape.forward, inward, 1.0 / radius, WHOLE_TURN - at_via, -angle)
    travel = at_goal if angle is None else angle
    return ArcShape(start, shape.forward, inward, 1.0 / radius, at_via, travel)


class ArcWay:
    """A CIRCLE's way along its arc; rows are given to it in order.

    `rotations` are those at start, via and end, (3, 3); `most_step` is the largest angle, rad, that the
    program's speed allows between rows: it tells in which round of a circle a row lies. `allowance`:
    turns that the tool may stand off by.
    """

    def __init__(
        self,
        shape: ArcShape,
        course: ArcCourse,
        rotations: tuple[Floats, Floats, Floats],
        most_step: float,
        allowance: Allowance = EXACT,
    ) -> None:
        start, via, goal = rotations
        self._shape = shape
        self._most_step = most_step
        self._raw, self._angle = 0.0, 0.0
        # So short a way is its own chord, and too short to take the share of a turn from.
        self._chord: LineWay | None = None
        if shape.travel < SHORT_WAY * shape.flatness:
            self._chord = LineWay((shape.start, start), (shape.end, goal), allowance)
        through = course.turns_through_via
        pairs = [(start, via), (via, goal)] if through else [(start, goal)]
        self._turns = [Turn(*pair, allowance) for pair in pairs]

    @property
    def length(self) -> float:
        """Length of the way, m."""
        return self._shape.travel / self._shape.flatness

    def deviation(self, positions: Floats, attitudes: Floats) -> PathDeviation:
        """Deviation of the next rows (positions (R, 3), attitudes (R, ..)) from the arc."""
        if self._chord is not None:
            return self._chord.deviation(positions, attitudes)
        shape = self._shape
        angles = self._rounds(shape.angles(positions))
        inside = np.clip(angles, 0.0, shape.travel)
        off_circle = np.linalg.norm(positions - shape.points(inside), axis=1)
        # Of rows more than a whole turn apart nobody can tell how many turns they make, nor what share of
        # the way that is.
        if self._most_step < WHOLE_TURN:
            travel, off_turn = shape.travel, self._off_turn(inside, attitudes)
        else:
            travel, off_turn = float(inside[-1]), np.zeros(len(inside))
        wanted = None if attitudes.shape[1] == 3 else self._wanted(inside)
        along, length = inside / shape.flatness, travel / shape.flatness
        return PathDeviation(off_circle, off_turn, along, length, False, wanted)

    @property
    def by_angle(self) -> bool:
        """Whether the angle of the turn gives the parameter of the way: of one too short to be an arc."""
        return self._chord is not None and self._chord.by_angle

    @property
    def reach(self) -> float:
        """Length of the way, m, or rad where it goes by the angle."""
        return self.length if self._chord is None else self._chord.reach

    def nearest(self, positions: Floats) -> Floats:
        """Way (R,) m to the points nearest to the next positions (R, 3)."""
        if self._chord is not None:
            return self._chord.nearest(positions)
        before = self._raw, self._angle
        angles = np.clip(self._rounds(self._shape.angles(positions)), 0.0, self._shape.travel)
        self._raw, self._angle = before
        return np.asarray(angles / self._shape.flatness)

    def travelled(self, positions: Floats, aside: float) -> tuple[Floats, float]:
        """Way (R,) m to the points nearest to the next positions (R, 3), which follow each other, and how far
        that is off the way at most where tools stand up to `aside` m beside it: of a point so far off the
        circle an angle of asin(aside / radius). Endless where that may be any point, or any round."""
        if self._chord is not None:
            return self._chord.travelled(positions, aside)
        flatness = self._shape.flatness
        angles = np.clip(self._rounds(self._shape.angles(positions)), 0.0, self._shape.travel)
        told = aside * flatness <= NEAR_THE_CIRCLE and self._most_step < 0.5 * np.pi
        off = float(np.arcsin(aside * flatness) / flatness) if told else np.inf
        return np.asarray(angles / flatness), off

    def at(self, way: Floats) -> tuple[Floats, Floats]:
        """Positions (R, 3) and orientations (R, 3, 3) after ways (R,) m."""
        shape = self._shape
        if self._chord is not None:
            return self._chord.at(way)
        angles = way * shape.flatness
        return shape.points(angles), self._wanted(angles)

    def _wanted(self, inside: Floats) -> Floats:
        """Orientations (R, 3, 3) of the arc at angles (R,) from its start."""
        share = inside / self._shape.travel
        if len(self._turns) == 1:
            return self._turns[0].at(share)
        part = self._shape.via / self._shape.travel
        before, behind = self._turns[0].at(eased(share / part)), eased((1.0 - share) / (1.0 - part))
        first = (inside < self._shape.via)[:, None, None]
        return np.asarray(np.where(first, before, self._turns[1].at(1.0 - behind)))

    def _off_turn(self, inside: Floats, attitudes: Floats) -> Floats:
        share = inside / self._shape.travel
        if len(self._turns) == 1:
            return self._turns[0].off(share, attitudes)
        before = inside < self._shape.via
        part = self._shape.via / self._shape.travel
        to_via, from_via = self._turns
        return np.where(
            before,
            to_via.off(eased(share / part), attitudes, before),
            from_via.off(1.0 - eased((1.0 - share) / (1.0 - part)), attitudes, ~before),
        )

    def _rounds(self, angles: Floats) -> Floats:
        """Angles (R,) from the start on, whole turns added so that no step is larger than `most_step`.

        A step is taken for one back only where that is the shorter way; where rows may be more than half a
        turn apart, for one forward. Rows that may be more than a whole turn apart cannot be told.
        """
        back = float(np.clip(WHOLE_TURN - self._most_step, NEARLY, np.pi))
        steps = np.diff(angles, prepend=self._raw)
        found = self._angle + np.cumsum((steps + back) % WHOLE_TURN - back)
        self._raw, self._angle = float(angles[-1]), float(found[-1])
        return np.asarray(found)


def eased(way: Floats) -> Floats:
    """Share of a turn (R,) at a share of its way: steady over the first half, coming to rest in the second.

    With rate 4/3 up to 1/2, falling linearly to 0 at 1: u = 4/3 x, then 1 - 4/3 (1 - x)^2.
    """
    return np.asarray(np.where(way < 0.5, 4.0 / 3.0 * way, 1.0 - 4.0 / 3.0 * (1.0 - way) ** 2))


def eased_rates(way: float) -> tuple[float, float]:
    """First and second derivative of `eased` at a share of its way."""
    return (4.0 / 3.0, 0.0) if way < 0.5 else (8.0 / 3.0 * (1.0 - way), -8.0 / 3.0)
