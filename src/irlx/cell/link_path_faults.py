"""What makes points no path for a link: too few, too near to each other, or a curve that meets itself."""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import NDArray

from irlx.robot.link_path import Point
from irlx.robot.plane_curve import PlaneCurve

Array = NDArray[np.float64]

LEAST_CHORD = 1e-3
"""Least distance of neighbouring points, m."""

LEAST_RADIUS = 0.01
"""Least radius of a bend, m; of two parts of the curve, or its straight ends, each keeps as much to itself.

A point that is nearer to the curve than this has one nearest point, and that moves on smoothly.
"""

STRAIGHT_ENDS = 1.0
"""Length of the straight ends, m, that keep off the curve and each other."""

LONGEST = 1000.0
"""Greatest length of the chords together, m: the whole curve is looked through at every tick."""

_STEP = 0.5 * LEAST_RADIUS


def fault_of_points(points: tuple[Point, ...], closed: bool) -> str:
    """Why the points (m) are no path, or ''."""
    least = 3 if closed else 2
    if len(points) < least:
        return f"a {'closed ' if closed else ''}path needs {least} points, found {len(points)}"
    ends = np.array([*points, *(points[:1] if closed else ())])
    chords = np.hypot(*np.diff(ends, axis=0).T)
    if not np.sum(chords) <= LONGEST:
        return "the path is longer than 1 km"
    near = np.flatnonzero(chords < LEAST_CHORD)
    if near.size:
        second = (int(near[0]) + 1) % len(points) + 1
        return f"points {int(near[0]) + 1} and {second} are less than 1 mm apart"
    return ""


def fault_of_curve(points: tuple[Point, ...], closed: bool) -> str:
    """Why no link could follow the curve through the points (m), or ''."""
    curve = PlaneCurve(np.array(points), closed)
    bends = np.abs(curve.curvatures())
    worst = int(np.argmax(bends))
    if bends[worst] * LEAST_RADIUS > 1.0:
        place = _in_mm(curve.samples[worst])
        return f"bends to a radius of {1e3 / bends[worst]:.3g} mm near {place}"
    return _near_itself(curve, closed)


def _near_itself(curve: PlaneCurve, closed: bool) -> str:
    # Imported here: few cells have paths.
    from scipy.spatial import cKDTree

    line = curve.samples if closed else _with_straight_ends(curve)
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    count = int(way[-1] / _STEP) + 2
    even = np.linspace(0.0, way[-1], count, endpoint=not closed)
    samples = np.column_stack([np.interp(even, way, line[:, k]) for k in (0, 1)])
    pairs = cKDTree(samples).query_pairs(2.0 * LEAST_RADIUS, output_type="ndarray")
    between = np.abs(even[pairs[:, 0]] - even[pairs[:, 1]])
    between = np.minimum(between, way[-1] - between) if closed else between
    # Along the curve itself its bends keep as far apart what is half a circle or more of them apart.
    met = pairs[between >= pi * LEAST_RADIUS]
    if not len(met):
        return ""
    apart = np.hypot(*(samples[met[:, 0]] - samples[met[:, 1]]).T)
    first = int(np.argmin(apart))
    return f"comes as near to itself as {1e3 * apart[first]:.2g} mm near {_in_mm(samples[met[first, 0]])}"


def _with_straight_ends(curve: PlaneCurve) -> Array:
    first, last = curve.ends
    before = [first.x - STRAIGHT_ENDS * first.tx, first.y - STRAIGHT_ENDS * first.ty]
    behind = [last.x + STRAIGHT_ENDS * last.tx, last.y + STRAIGHT_ENDS * last.ty]
    return np.vstack([before, curve.samples, behind])


def _in_mm(point: Array) -> str:
    x, y = np.round(1e3 * point) + 0.0
    return f"({x:.0f}, {y:.0f}) mm"
