"""Moves that pass their targets, made by hand for the gantry: curves, their blends and the rows along them.

Blends by scipy's polynomials in Bernstein form from derivatives, splines by its CubicSpline; ways by tables
of small chords. Nothing of irlx makes a row.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.interpolate import BPoly, CubicSpline, make_interp_spline
from scipy.spatial.transform import Rotation

Vector = np.ndarray
FINE = 2001


@dataclass(frozen=True)
class Curve:
    """A way by its length s: position, tangent, second derivative and orientation, all by closed form.

    `turn_at_start` and `turn_at_end`: rotation vector by the length there, in the tool's frame.
    """

    length: float
    point: Callable[[Vector], Vector]
    tangent: Callable[[float], Vector]
    bend: Callable[[float], Vector]
    rotation: Callable[[Vector], Rotation]
    turn: Callable[[float], Vector]
    room: tuple[float, float]


def line(start: Vector, end: Vector, first: Rotation, turn: Vector) -> Curve:
    """Straight from one point to another, turned by a rotation vector in the tool's frame."""
    start, end, turn = (np.asarray(v, dtype=float) for v in (start, end, turn))
    length = float(np.linalg.norm(end - start))
    along = (end - start) / length
    return Curve(
        length,
        lambda s: start + np.multiply.outer(s, along),
        lambda s: along,
        lambda s: np.zeros(3),
        lambda s: first * Rotation.from_rotvec(np.multiply.outer(s / length, turn)),
        lambda s: turn / length,
        (length / 2, length / 2),
    )


def arc(start: Vector, centre: Vector, axis: Vector, angle: float, first: Rotation, turn: Vector) -> Curve:
    """About an axis through a centre, by an angle."""
    start, centre, axis, turn = (np.asarray(v, dtype=float) for v in (start, centre, axis, turn))
    arm = start - centre
    radius = float(np.linalg.norm(arm))
    length = radius * angle

    def spun(s: Vector, vector: Vector) -> Vector:
        return Rotation.from_rotvec(np.multiply.outer(np.asarray(s) / radius, axis)).apply(vector)

    return Curve(
        length,
        lambda s: centre + spun(s, arm),
        lambda s: spun(s, np.cross(axis, arm) / radius),
        lambda s: spun(s, -arm / radius**2),
        lambda s: first * Rotation.from_rotvec(np.multiply.outer(s / length, turn)),
        lambda s: turn / length,
        (length / 2, length / 2),
    )


class Table:
    """A parametrised curve by its length, from a fine table of small chords."""

    def __init__(self, point: Callable[[Vector], Vector], most: float, kinks: Vector | None = None) -> None:
        self.u = np.linspace(0.0, most, FINE)
        nodes, weights = np.polynomial.legendre.leggauss(3)
        step = most / (FINE - 1)
        rate = point.derivative()  # type: ignore[attr-defined]
        middle = (self.u[:-1] + step / 2)[:, None] + step / 2 * nodes
        speed = np.linalg.norm(rate(middle.ravel()), axis=1).reshape(middle.shape)
        self.s = np.concatenate([[0.0], np.cumsum(step / 2 * speed @ weights)])
        self.length = float(self.s[-1])
        self._u_of = make_interp_spline(self.s, self.u, k=3)
        self._s_of = make_interp_spline(self.u, self.s, k=3)

    def parameter(self, s: Vector) -> Vector:
        return np.clip(self._u_of(np.clip(s, 0.0, self.length)), 0.0, self.u[-1])

    def way(self, u: Vector) -> Vector:
        return self._s_of(u)


@dataclass(frozen=True)
class Piece:
    """A stretch of a way: poses by the length from its start; where the corner lies on it, of a blend."""

    length: float
    pose: Callable[[Vector], tuple[Vector, Rotation]]
    corner: float | None = None


def blend(first: Curve, second: Curve, distance: float, tangent: float | None = None) -> Piece:
    """The quintic from `distance` before a corner to as far behind; `tangent` in parts of the arc between."""
    a, b = first.length - distance, distance
    p0, p1 = first.point(np.array([a]))[0], second.point(np.array([b]))[0]
    t0, t1, k0, k1 = first.tangent(a), second.tangent(b), first.bend(a), second.bend(b)
    half = 0.5 * np.arccos(np.clip(t0 @ t1, -1, 1))
    chord = np.linalg.norm(p1 - p0) * (half / np.sin(half) if half > 1e-9 else 1.0)

    def join(share: float) -> BPoly:
        size = share * chord
        ends = [[p0, size * t0, size**2 * k0], [p1, size * t1, size**2 * k1]]
        return BPoly.from_derivatives([0.0, 1.0], ends)

    curve = join(flattest(join, chord) if tangent is None else tangent)
    table = Table(curve, 1.0)
    corner = second.point(np.zeros(1))[0]
    apart = np.linalg.norm(curve(table.u) - corner, axis=1)
    base = second.rotation(np.zeros(1))[0]
    r0, r1 = ((base.inv() * c.rotation(np.array([s]))[0]).as_rotvec() for c, s in ((first, a), (second, b)))
    # From the corner both turns are about fixed axes: vectors and rates are parallel, nothing bends.
    turns = BPoly.from_derivatives(
        [0.0, table.length], [[r0, first.turn(a), np.zeros(3)], [r1, second.turn(b), np.zeros(3)]]
    )

    def pose(s: Vector) -> tuple[Vector, Rotation]:
        return curve(table.parameter(s)), base * Rotation.from_rotvec(turns(np.clip(s, 0.0, table.length)))

    return Piece(table.length, pose, float(table.s[np.argmin(apart)]))


def flattest(join: Callable[[float], BPoly], arc_length: float) -> float:
    """The tangent of 0.75, 0.80 .. 1.45 with which the largest curvature of 33 places is the least."""
    u = np.linspace(0.0, 1.0, 33)
    best = {}
    for share in np.linspace(0.75, 1.45, 15):
        curve = join(share)
        rate, change = curve.derivative()(u), curve.derivative(2)(u)
        size = np.linalg.norm(rate, axis=1)
        worst = np.max(np.linalg.norm(np.cross(rate, change), axis=1) / size**3)
        best[worst + 1e-6 / arc_length * abs(share - 0.9)] = share
    return float(best[min(best)])


@dataclass
class Way:
    """Curves with blends between them: poses by the length, and the ways at which corners are passed."""

    pieces: list[Piece]
    ends: list[float] = field(default_factory=list)

    @cached_property
    def breaks(self) -> Vector:
        return np.concatenate([[0.0], np.cumsum([piece.length for piece in self.pieces])])

    @property
    def length(self) -> float:
        return float(self.breaks[-1])

    def poses(self, s: Vector) -> tuple[Vector, Vector]:
        """Positions (N, 3) and rotation matrices (N, 3, 3)."""
        number = np.clip(np.searchsorted(self.breaks, s, side="right") - 1, 0, len(self.pieces) - 1)
        points, turns = np.empty((len(s), 3)), np.empty((len(s), 3, 3))
        for k in np.unique(number):
            here = number == k
            points[here], turned = self.pieces[k].pose(s[here] - self.breaks[k])
            turns[here] = turned.as_matrix()
        return points, turns


def way_of(curves: list[Curve], distances: list[float], tangent: float | None = None) -> Way:
    """The way along curves, each corner passed at its distance (0: sharp)."""
    way = Way([])
    reached, begin = 0.0, 0.0
    for k, curve in enumerate(curves):
        distance = distances[k] if k < len(distances) else 0.0
        length = curve.length - distance - begin
        way.pieces.append(part(curve, begin, length))
        reached += length
        begin = distance
        if distance > 0.0:
            join = blend(curve, curves[k + 1], distance, tangent)
            way.pieces.append(join)
            assert join.corner is not None
            way.ends.append(reached + join.corner)
            reached += join.length
        else:
            way.ends.append(reached)
    return way


def part(curve: Curve, begin: float, length: float) -> Piece:
    return Piece(length, lambda s: (curve.point(begin + s), curve.rotation(begin + s)))


def spline(poses: list[tuple[Vector, Rotation]]) -> tuple[Piece, Vector]:
    """Natural cubic spline over the chords, and the ways at its points; turns from point to point."""
    points = np.array([position for position, _ in poses])
    chords = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    curve = CubicSpline(chords, points, bc_type="natural")
    table = Table(curve, float(chords[-1]))
    at = table.way(chords)
    turned = [rotation for _, rotation in poses]
    steady = [
        (a.apply((a.inv() * b).as_rotvec())) / width
        for a, b, width in zip(turned[:-1], turned[1:], np.diff(at), strict=True)
    ]
    rates = [steady[0]]
    for a, b, before, behind in zip(steady[:-1], steady[1:], np.diff(at)[:-1], np.diff(at)[1:], strict=True):
        mean = (behind * a + before * b) / (before + behind)
        most = 1.5 * min(np.linalg.norm(a), np.linalg.norm(b))
        rates.append(np.zeros(3) if a @ b <= 0 else mean * min(1.0, most / np.linalg.norm(mean)))
    rates.append(steady[-1])
    pieces = [
        BPoly.from_derivatives([at[k], at[k + 1]], [_jet(turned[k], turned[j], rates[j]) for j in (k, k + 1)])
        for k in range(len(steady))
    ]

    def pose(s: Vector) -> tuple[Vector, Rotation]:
        number = np.clip(np.searchsorted(at, s, side="right") - 1, 0, len(pieces) - 1)
        # Ways are in order, and so are the pieces that they lie on.
        turns = [turned[k] * Rotation.from_rotvec(pieces[k](s[number == k])) for k in np.unique(number)]
        return curve(table.parameter(s)), Rotation.concatenate(turns)

    return Piece(table.length, pose), at


def _jet(base: Rotation, rotation: Rotation, rate: Vector) -> list[Vector]:
    """Rotation vector from a base, and its derivatives where the angular rate is steady; by differences."""
    step = 1e-4
    places = np.arange(-3, 4) * step
    vectors = np.array([(base.inv() * Rotation.from_rotvec(rate * h) * rotation).as_rotvec() for h in places])
    first = np.array([-1, 9, -45, 0, 45, -9, 1]) / 60 / step
    second = np.array([2, -27, 270, -490, 270, -27, 2]) / 180 / step**2
    return [vectors[3], first @ vectors, second @ vectors]


def trapezoid(length: float, speed: float, acc: float, dt: float) -> Vector:
    """Way at ticks 1, 2, .. from rest to rest, slowed to whole ticks; the last is the length."""
    ramp = speed / acc
    if length < speed * ramp:
        ramp = np.sqrt(length / acc)
        speed = ramp * acc
    due = length / speed + ramp
    ticks = int(np.ceil(due / dt - 1e-9))
    t = np.arange(1, ticks + 1) * dt * due / (ticks * dt)
    up, down = np.minimum(t, ramp), np.clip(t - (due - ramp), 0.0, ramp)
    even = np.clip(t - ramp, 0.0, due - 2 * ramp)
    s = 0.5 * acc * up**2 + speed * even + speed * down - 0.5 * acc * down**2
    s[-1] = length
    return s


def postures(points: Vector, turns: Vector, rail: float = 0.0) -> Vector:
    """Joint values (N, 7) of the gantry for poses of its tool."""
    angles = Rotation.from_matrix(turns).as_euler("ZYX")
    rails = np.full(len(points), rail)
    return np.column_stack([rails, points[:, 0] - rail, points[:, 1:], angles])
