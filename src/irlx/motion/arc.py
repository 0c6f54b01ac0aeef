"""Circles through three points, and arcs on them with the orientation turning in step."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import atan2, remainder, tau
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from irlx.motion.swept_path import SweptPath
from irlx.motion.turn import Turning

Array = NDArray[np.float64]

NEAREST_POINTS = 1e-6
"""Points of a circle nearer to each other, or to a line, than this (m) do not define it."""

_WHOLE_TURNS = 1e-15
"""Angles this near to whole turns, relative, are whole turns: what radians() leaves of degrees."""


class Spread(NamedTuple):
    """How far three points lie apart, m: the sides of their triangle, and its height over the longest."""

    start_via: float
    via_end: float
    start_end: float
    height: float


@dataclass(frozen=True)
class Circle:
    """A circle, run through from `start` in the direction of `tangent`.

    point(phi) = start + radius (sin phi tangent + (1 - cos phi) normal); `normal` points from `start` to
    the centre, both are unit vectors (3,). `start` (3,) and `radius` in m. The via point lies at
    `via_angle`, the end point at `end_angle`, rad in 0..2 pi, the end point behind the via point.
    """

    start: Array
    tangent: Array
    normal: Array
    radius: float
    via_angle: float
    end_angle: float

    @classmethod
    def through(cls, start: Array, via: Array, end: Array) -> Circle:
        """Circle through three points (3,), m, that are no line, run from start over via to end.

        With the sides a, b, d of `_sides`: radius = |a| |b| |d| / (2 |a x b|), and the tangent at the
        start is a/|a|^2 - b/|b|^2 made a unit vector, because the inversion in the start turns the circle
        into a line along its tangent. The angles at the centre are twice those at the circumference.
        """
        scale, a, b, d = _sides(start, via, end)
        cross = _cross(a, b, d)
        area = float(np.linalg.norm(cross))
        # |b|^2 a - |a|^2 b, with b = a + d where d is the shorter one.
        tangent = _unit((d @ (a + b)) * a - (a @ a) * d if d @ d < b @ b else (b @ b) * a - (a @ a) * b)
        # On flat arcs the tangent is known better than the plane: the normal gives way, not the tangent.
        normal = _unit(np.cross(cross, tangent))
        lengths = [float(np.linalg.norm(side)) for side in (a, b, d)]
        radius = scale * lengths[0] * lengths[1] * lengths[2] / (2.0 * area)
        via_angle, end_angle = 2.0 * atan2(area, float(b @ d)), 2.0 * atan2(area, float(a @ d))
        return cls(start, tangent, normal, radius, via_angle, end_angle)

    @property
    def reversed(self) -> Circle:
        """The same circle run through the other way."""
        via, end = tau - self.via_angle, tau - self.end_angle
        return replace(self, tangent=-self.tangent, via_angle=via, end_angle=end)

    def share_at_via(self, travel: float) -> float | None:
        """Share of a travel, rad, at which the via point is passed for the first time, inside 0..1.

        None where the travel does not come to it, or ends there.
        """
        if self.radius * (travel - self.via_angle) < NEAREST_POINTS:
            return None
        return self.via_angle / travel

    def points(self, angles: Array) -> Array:
        """Points (N, 3), m, at the angles (N,), rad, from the start.

        The chord 2 r sin(phi/2) along its direction: no difference of large numbers on flat arcs.
        """
        half = 0.5 * angles[:, None]
        direction = np.cos(half) * self.tangent + np.sin(half) * self.normal
        return np.asarray(self.start + 2.0 * self.radius * np.sin(half) * direction)

    def point_after(self, travel: float) -> Array:
        """Point (3,) after an angle, rad; after whole turns the start to the last bit."""
        if abs(remainder(travel, tau)) <= _WHOLE_TURNS * travel:
            return self.start
        return np.asarray(self.points(np.array([travel]))[0])


def spread(start: Array, via: Array, end: Array) -> Spread:
    """Distances and height of three points (3,), m."""
    scale, a, b, d = _sides(start, via, end)
    lengths = [float(np.linalg.norm(side)) for side in (a, d, b)]
    area = float(np.linalg.norm(_cross(a, b, d)))
    height = area / max(lengths) if max(lengths) > 0.0 else 0.0
    start_via, via_end, start_end = (scale * length for length in lengths)
    return Spread(start_via, via_end, start_end, scale * height)


def _sides(start: Array, via: Array, end: Array) -> tuple[float, Array, Array, Array]:
    """Scale (m) and, divided by it so that no square overflows, sides a start-via, b start-end, d via-end."""
    a, b, d = via - start, end - start, end - via
    scale = float(np.max(np.abs([a, b, d])))
    return (scale, a / scale, b / scale, d / scale) if scale > 0.0 else (1.0, a, b, d)


def _unit(vector: Array) -> Array:
    return np.asarray(vector / np.linalg.norm(vector))


def _cross(a: Array, b: Array, d: Array) -> Array:
    """a x b = a x d = b x d, of the two shortest sides: its rounding grows with their lengths."""
    longest = int(np.argmax([a @ a, b @ b, d @ d]))
    first, second = [(b, d), (a, d), (a, b)][longest]
    return np.asarray(np.cross(first, second))


@dataclass(frozen=True)
class Arc(SweptPath):
    """Way along a circle, any number of times round it: s is the arc length.

    position(s) = circle.point(s / radius), from the circle's start over `travel` rad (> 0);
    rotation(s) = orientation at the share s / length. `end_position` (3,) m and `end_rotation` (3, 3) are
    what the last pose is exactly. A travel of less than `SHORTEST_WAY` is a pure turn, like that of a line.
    """

    circle: Circle
    travel: float
    end_position: Array
    end_rotation: Array
    orientation: Turning

    @property
    def turning(self) -> Turning:
        """How the orientation changes on the way."""
        return self.orientation

    @property
    def share_at_via(self) -> float | None:
        """Share of the way at which the via point is passed for the first time; see `Circle.share_at_via`."""
        return self.circle.share_at_via(self.travel)

    @property
    def translation(self) -> float:
        """Arc length, m."""
        return self.circle.radius * self.travel

    def _positions(self, share: Array) -> Array:
        return self.circle.points(self.travel * share)

    def _directions(self, share: Array) -> Array:
        phi = self.travel * share[:, None]
        direction = np.cos(phi) * self.circle.tangent + np.sin(phi) * self.circle.normal
        return np.asarray(self.translation * direction)

    def _bends(self, share: Array) -> Array:
        phi = self.travel * share[:, None]
        inward = np.cos(phi) * self.circle.normal - np.sin(phi) * self.circle.tangent
        return np.asarray(self._peak_bend * inward)

    @property
    def _peak_bend(self) -> float:
        return self.translation * self.travel
