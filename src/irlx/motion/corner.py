"""Whether and how far a corner between two edges is blended."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi, sqrt

import numpy as np
from numpy.typing import NDArray

from irlx.motion.blended_corner import BlendedCorner, blended_corner
from irlx.motion.edges import Edge
from irlx.motion.line import Line

Array = NDArray[np.float64]

REVERSAL = 0.01
"""A corner this near (rad) to a reversal is one: what is left of a curve there is a stop in all but name."""

LEAST_BLEND = 1e-6
"""Shortest distance of a blend, m: curves much smaller would be made of the rounding of their points."""

NEAREST_ENDS = REVERSAL * LEAST_BLEND
"""Ends of a blend nearer to each other, m, are one point, as on a circle that is run twice: nothing but the
rounding of both would tell what leads from the one to the other."""

LEAST_PASS = 1e-4
"""Shortest distance of a blend by C_PASS, m."""

LONGEST_WAY = 1e6
"""Longest way beside a blend, m: from there on, too, it would be made of rounding."""

_CURVE_SHARE = 0.7
"""Part of ACC that an arc may take across where a blend at the programmed speed shall join it."""

_ENOUGH = 1e-3
_TURNS_BACK = "the path turns back on itself"


@dataclass(frozen=True)
class Lost:
    """Why a corner is no blend; an empty `reason` where none was asked for."""

    reason: str = ""


@dataclass(frozen=True)
class Corner:
    """A blend of `distance` m; `cut` tells that more was asked for than half of the shorter neighbour."""

    blend: BlendedCorner
    distance: float
    cut: bool


def corner_between(before: Edge, after: Edge) -> Corner | Lost:
    """The blend between two edges that follow each other, or why there is none."""
    asked = before.blend
    if asked is None or asked.distance == 0.0:
        return Lost()
    reason = _hindrance(before, after)
    if reason:
        return Lost(reason)
    room = min(before.room[1], after.room[0])
    if asked.distance is not None:
        distance = min(asked.distance, room)
    else:
        distance = min(max(_least_distance(before, after, room), LEAST_PASS), room)
    if distance < LEAST_BLEND:
        return Lost(f"{distance * 1000.0:.3g} mm beside the corner are next to nothing")
    reason = _without_curve(before, after, distance)
    if reason:
        return Lost(reason)
    blend = blended_corner(before.path, after.path, distance)
    return Corner(blend, distance, asked.distance is not None and asked.distance > room)


def _hindrance(before: Edge, after: Edge) -> str:
    """What keeps two edges from being blended, or ''."""
    for edge, name in ((before, "this move"), (after, "the next move")):
        if edge.path.is_nothing:
            return f"{name} has no length"
        if edge.path.is_pure_turn:
            return f"{name} turns the tool on the spot"
        if not edge.path.length < LONGEST_WAY:
            return f"{name} is too long"
    leaving = before.path.derivatives(np.array([before.path.length]))[0][0]
    joining = after.path.derivatives(np.array([0.0]))[0][0]
    return _TURNS_BACK if _angle(leaving, joining) > pi - REVERSAL else ""


def _without_curve(before: Edge, after: Edge, distance: float) -> str:
    """Why no curve leads from one end of a blend to the other, or ''."""
    places = (before.path, np.array([before.path.length - distance])), (after.path, np.array([distance]))
    left, joined = (path.poses(s).position[0] for path, s in places)
    if np.linalg.norm(joined - left) < NEAREST_ENDS:
        return f"{distance * 1000.0:.6g} mm beside the corner lead back to where they begin"
    back = (_angle(path.derivatives(s)[0][0], joined - left) > pi - REVERSAL for path, s in places)
    return _TURNS_BACK if all(back) else ""


def _angle(a: Array, b: Array) -> float:
    return float(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b))


def _least_distance(before: Edge, after: Edge, room: float) -> float:
    """Smallest distance at which a blend keeps the speed that both neighbours have, at most `room`.

    What a blend bends is nearly a constant plus a term with 1/distance; between straight lines it is that
    term alone.
    """
    speeds = _speed(before), _speed(after)

    def excess(inverse: float) -> float:
        if _without_curve(before, after, 1.0 / inverse):
            return inf
        blend = blended_corner(before.path, after.path, 1.0 / inverse)
        return _strain(blend, (before, after), speeds) - 1.0

    if room <= LEAST_PASS:
        return room
    least, most = 1.0 / room, 1.0 / LEAST_PASS
    at_room = excess(least)
    if isinstance(before.path, Line) and isinstance(after.path, Line):
        return room * (1.0 + min(at_room, 0.0))
    if excess(most) <= 0.0:
        return LEAST_PASS
    if at_room >= 0.0:
        return room
    from scipy.optimize import brentq

    return min((1.0 + _ENOUGH) / float(brentq(excess, least, most, rtol=_ENOUGH)), room)


def _speed(edge: Edge) -> float:
    """Programmed speed of an edge, less where its own curve or turn does not allow it."""
    law = edge.law
    curvature, turn_rate = float(np.max(edge.shape.curvature)), float(np.max(edge.shape.turn_rate))
    across = sqrt(_CURVE_SHARE * law.acc / curvature) if curvature > 0.0 else law.speed
    turning = law.speed_ori / turn_rate if turn_rate > 0.0 else law.speed
    return min(law.speed, across, turning)


def _strain(blend: BlendedCorner, edges: tuple[Edge, Edge], speeds: tuple[float, float]) -> float:
    """How many times the accelerations allowed a blend needs at the speeds of its two sides."""
    worst = 0.0
    for edge, speed, part in zip(edges, speeds, blend.halves, strict=True):
        worst = max(worst, speed**2 * float(np.max(part.curvature)) / edge.law.acc)
        worst = max(worst, 2.0 * speed**2 * float(np.max(part.turn_bend)) / edge.law.acc_ori)
    return worst
