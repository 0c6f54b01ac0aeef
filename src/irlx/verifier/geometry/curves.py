"""Curves that chains of moves consist of, by their length: straight lines and arcs with their turns."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from irlx.blocks import ArcCourse
from irlx.streams.joint_stream import Floats
from irlx.verifier.geometry.arcs import NEARLY, WHOLE_TURN, ArcShape
from irlx.verifier.geometry.attitudes import Attitude, SteadyTurn, Turning, ViaTurn

Pose = tuple[Floats, Floats]


class Curve(Protocol):
    """A way of the tool by its length s, m: 0 at its start, `length` at its end."""

    @property
    def length(self) -> float:
        """Length of the whole way, m."""

    @property
    def is_straight(self) -> bool:
        """Whether it is a straight line."""

    @property
    def angle(self) -> float:
        """Angle that the tool turns on it, rad."""

    @property
    def room(self) -> tuple[float, float]:
        """How far from its start and from its end a blend may reach, m."""

    @property
    def whole(self) -> float:
        """Way after which it comes by the same points again, m: the whole turn of a circle; else endless."""

    def nearest(self, positions: Floats, near: float) -> Floats:
        """Way (R,) to the points nearest to positions (R, 3), in order, the row before them being at `near`.

        It goes on before the start and behind the end, by the tangents there or the curve itself.
        """

    def nearest_at_start(self, positions: Floats) -> Floats:
        """The same for positions (R, 3) that are about its start, if on it at all."""

    def points(self, way: Floats) -> Floats:
        """Positions (R, 3), m."""

    def tangents(self, way: Floats) -> Floats:
        """Unit tangents (R, 3)."""

    def bends(self, way: Floats) -> Floats:
        """Second derivatives (R, 3) by the way: curvature in 1/m, times the unit normal."""

    def rotations(self, way: Floats) -> Floats:
        """Orientations (R, 3, 3)."""

    def turnings(self, way: float) -> list[Turning]:
        """Orientation and its rates by the way, at a place: where they jump on both sides of it."""


class LineCurve:
    """The straight line between two poses."""

    is_straight = True
    whole = np.inf

    def __init__(self, start: Pose, goal: Pose) -> None:
        self._start = start[0]
        step = goal[0] - start[0]
        self.length = float(np.linalg.norm(step))
        self._forward = step / self.length if self.length > 0.0 else np.zeros(3)
        self.room = 0.5 * self.length, 0.5 * self.length
        self._turn = SteadyTurn(start[1], goal[1])

    @property
    def angle(self) -> float:
        """Angle of the turn, rad."""
        return self._turn.angle

    def nearest(self, positions: Floats, near: float) -> Floats:
        """Projection (R,) on the line."""
        return np.asarray((positions - self._start) @ self._forward)

    def nearest_at_start(self, positions: Floats) -> Floats:
        """Projection (R,) on the line."""
        return self.nearest(positions, 0.0)

    def points(self, way: Floats) -> Floats:
        """Positions (R, 3)."""
        return np.asarray(self._start + way[:, None] * self._forward)

    def tangents(self, way: Floats) -> Floats:
        """The line's direction (R, 3)."""
        return np.broadcast_to(self._forward, (len(way), 3))

    def bends(self, way: Floats) -> Floats:
        """Zeros (R, 3)."""
        return np.zeros((len(way), 3))

    def rotations(self, way: Floats) -> Floats:
        """Orientations (R, 3, 3)."""
        return self._turn.at(way / self.length if self.length > 0.0 else np.ones_like(way))

    def turnings(self, way: float) -> list[Turning]:
        """Orientation and its rates at a place."""
        return _by_way(self._turn, way, self.length)


class ArcCurve:
    """The arc of a CIRCLE; `rotations` are those at start, via point and end, `most_step` the largest angle,
    rad, between two rows, less than a whole turn."""

    is_straight = False

    def __init__(
        self,
        shape: ArcShape,
        course: ArcCourse,
        rotations: tuple[Floats, Floats, Floats],
        most_step: float = 0.0,
    ) -> None:
        self._shape = shape
        # A step is one back where that is the shorter way, if rows cannot be as far apart forwards.
        self._back = float(np.clip(WHOLE_TURN - most_step, NEARLY, np.pi))
        self.length = shape.travel / shape.flatness
        self.whole = WHOLE_TURN / shape.flatness
        self._turn: Attitude = SteadyTurn(rotations[0], rotations[2])
        self.room = 0.5 * self.length, 0.5 * self.length
        if course.turns_through_via:
            # No blend takes the orientation of the via point away.
            via = shape.via / shape.travel
            self._turn = ViaTurn(rotations, via)
            self.room = min(0.5, via) * self.length, min(0.5, 1.0 - via) * self.length

    @property
    def angle(self) -> float:
        """Angle of the turn, rad."""
        return self._turn.angle

    def nearest(self, positions: Floats, near: float) -> Floats:
        """Way (R,) along the circle, in steps of half a turn at most from the row before, or as far forwards
        as they can be."""
        last = near * self._shape.flatness
        steps = np.diff(self._shape.angles(positions), prepend=last)
        found = last + np.cumsum((steps + self._back) % WHOLE_TURN - self._back)
        return np.asarray(found / self._shape.flatness)

    def nearest_at_start(self, positions: Floats) -> Floats:
        """Way (R,) along the circle, half a turn to either side."""
        return np.asarray(self._shape.angles(positions) / self._shape.flatness)

    def points(self, way: Floats) -> Floats:
        """Positions (R, 3)."""
        return self._shape.points(way * self._shape.flatness)

    def tangents(self, way: Floats) -> Floats:
        """Unit tangents (R, 3)."""
        angles = way * self._shape.flatness
        forward, inward = self._shape.forward, self._shape.inward
        return np.asarray(np.cos(angles)[:, None] * forward + np.sin(angles)[:, None] * inward)

    def bends(self, way: Floats) -> Floats:
        """Curvature (R, 3) towards the centre."""
        angles = way * self._shape.flatness
        forward, inward = self._shape.forward, self._shape.inward
        towards = np.cos(angles)[:, None] * inward - np.sin(angles)[:, None] * forward
        return np.asarray(self._shape.flatness * towards)

    def rotations(self, way: Floats) -> Floats:
        """Orientations (R, 3, 3)."""
        return self._turn.at(way / self.length)

    def turnings(self, way: float) -> list[Turning]:
        """Orientation and its rates at a place."""
        return _by_way(self._turn, way, self.length)


def rounds(curve: Curve, way: Floats) -> list[Floats]:
    """Ways (R,) at which a curve comes by the same points as at `way` (R,), these first: of a circle those of
    all its turns up to its end."""
    if not np.isfinite(curve.whole) or not len(way):
        return [way]
    turns = int((curve.length - float(np.min(way))) / curve.whole + NEARLY)
    return [way + turn * curve.whole for turn in range(max(turns, 0) + 1)]


def _by_way(turn: Attitude, way: float, length: float) -> list[Turning]:
    return [
        Turning(rotation, rate / length, change / length**2)
        for rotation, rate, change in turn.turnings(way / length)
    ]
