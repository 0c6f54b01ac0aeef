"""The legs of a chain of moves, rebuilt from their blocks, and what is allowed on each of them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import sqrt

import numpy as np

from irlx.blocks import Blend, MotionLaw, MoveKind, Profile
from irlx.promises import PROGRAM_EXCESS
from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.demands import Demand
from irlx.verifier.geometry.arcs import WHOLE_TURN, ArcShape, arc_shape
from irlx.verifier.geometry.chain_parts import Leg
from irlx.verifier.geometry.corners import Corner
from irlx.verifier.geometry.curves import ArcCurve, Curve, LineCurve
from irlx.verifier.geometry.paths import TURN_RULES
from irlx.verifier.geometry.rotations import angle_between
from irlx.verifier.geometry.splines import SplineCurve
from irlx.verifier.tools import Pose

NOTHING = 1e-9
"""A PATH whose first point is nearer to the start than this, m and rad, begins there."""

REVERSAL = 0.01
"""A corner nearer to a reversal than this, rad, cannot be rounded."""


class Unplaced(Exception):
    """The way of a chain cannot be rebuilt; the message says of how many moves and why."""


class NoCurve(Exception):
    """No way fulfils what a chain asks for: three points that make no circle."""


@dataclass(frozen=True, eq=False)
class ChainLegs:
    """K legs, with the bounds on each (K,): `speed` m/s, `turn` rad/s, `acc` m/s2 and `along`, the same where
    its turn is counted in, `jerk` m/s3, infinite where none is asked for. `last_of` (M,): the last leg of
    each of M moves. `free_end`: way on the last leg from which on nobody knows how it goes on, None where it
    ends.
    """

    legs: tuple[Leg, ...]
    speed: Floats
    turn: Floats
    acc: Floats
    along: Floats
    jerk: Floats
    last_of: Integers
    free_end: float | None


def legs_of(chain: tuple[Demand, ...], dt: float) -> ChainLegs:
    """The legs of a chain of which there is a row every `dt` s; raises Unplaced and NoCurve."""
    moves = [_curves(demand, dt) for demand in chain]
    curves = [curve for own in moves for curve in own]
    corners = [corner for demand, own in zip(chain, moves, strict=True) for corner in _corners(demand, own)]
    pairs = zip(curves, [*curves[1:], curves[-1]], corners, strict=True)
    legs = [Leg(curve, _cut(corner, curve, following)) for curve, following, corner in pairs]
    laws = [demand.move.law for demand, own in zip(chain, moves, strict=True) for _ in own]
    along = [
        min(law.acc, law.acc_ori * curve.length / curve.angle)
        if curve.is_straight and curve.angle > 0.0
        else law.acc
        for law, curve in zip(laws, curves, strict=True)
    ]
    last, blend = chain[-1], chain[-1].move.block.blend
    free_end = None
    if not last.move.finished and blend is not None:
        room = curves[-1].room[1]
        free_end = curves[-1].length - min(room, room if blend.distance is None else blend.distance)
    return ChainLegs(
        tuple(legs),
        np.array([law.speed for law in laws]),
        np.array([law.speed_ori for law in laws]),
        np.array([law.acc for law in laws]),
        np.array(along),
        np.array([jerk_of(law) for law in laws]),
        np.cumsum([len(own) for own in moves]) - 1,
        free_end,
    )


def jerk_of(law: MotionLaw) -> float:
    """Largest jerk along the path, m/s3, infinite where a law bounds none."""
    return law.jerk if law.profile is Profile.S_CURVE and law.jerk is not None else np.inf


def end_reach(demand: Demand) -> float:
    """How far a corner into a PTP may reach into a move of the tool, m: to C_CP, at most half of it."""
    blend = demand.move.block.blend
    asked = np.inf if blend is None or blend.distance is None else blend.distance
    try:
        return float(min(asked, _curves(demand)[-1].room[1]))
    except (Unplaced, NoCurve):
        return float(asked)


def _curves(demand: Demand, dt: float = 0.0) -> list[Curve]:
    """The curves of one move, with a row every `dt` s."""
    block = demand.move.block
    if demand.allowance.shifts:
        raise Unplaced("displacements WITH TOLERANCE along their PATH are not judged")
    poses = [place.pose for place in (demand.start, *demand.targets) if place.pose is not None]
    if len(poses) < len(demand.targets) + 1:
        raise Unplaced("targets in other frames than R_BASE cannot be placed")
    if block.arc is not None:
        shape = arc_shape(poses[0][0], poses[1][0], poses[2][0], block.arc.angle)
        if shape is None:
            raise NoCurve
        end = poses[2] if block.arc.angle is None else (shape.end, poses[2][1])
        step = _largest_turn(shape, demand.move.law, dt)
        if not step < WHOLE_TURN:
            raise Unplaced("tool may go round a circle more than once between two rows")
        return [ArcCurve(shape, block.arc, (poses[0][1], poses[1][1], end[1]), step)]
    if len(poses) > 2 and _are_same(poses[0], poses[1]):
        del poses[1]
    if block.kind is MoveKind.SPLINE and len(poses) > 2:
        return [SplineCurve(poses)]
    lines = [LineCurve(start, goal) for start, goal in pairwise(poses)]
    if any(not line.length > TURN_RULES * line.angle for line in lines):
        raise Unplaced("pieces of their PATH turn the tool on the spot")
    return list(lines)


def _largest_turn(shape: ArcShape, law: MotionLaw, dt: float) -> float:
    """Angle, rad, that a tool at the most goes on along a circle between two rows, by SPEED and ACC."""
    return min(law.speed * shape.flatness, sqrt(law.acc * shape.flatness)) * dt * (1.0 + PROGRAM_EXCESS)


def _are_same(one: Pose, other: Pose) -> bool:
    apart = float(np.linalg.norm(one[0] - other[0])), float(angle_between(one[1], other[1]))
    return max(apart) < NOTHING


def _corners(demand: Demand, curves: list[Curve]) -> list[Corner]:
    """How the ends of a move's curves are passed: at its inner points it may stop as well."""
    blend = demand.move.block.blend
    inner = [_asked(blend, may_stop=True)] * (len(curves) - 1)
    return [*inner, _asked(blend if demand.passes else None, may_stop=False)]


def _asked(blend: Blend | None, may_stop: bool) -> Corner:
    if blend is None:
        return Corner(0.0)
    if blend.distance is None:
        return Corner(np.inf, may_be_less=True)
    return Corner(blend.distance, may_stop=may_stop)


def _cut(corner: Corner, before: Curve, after: Curve) -> Corner:
    """The corner with a distance for which there is room between two curves."""
    distance = min(corner.distance, before.room[1], after.room[0])
    out, into = before.tangents(np.array([before.length]))[0], after.tangents(np.zeros(1))[0]
    angle = float(np.arctan2(np.linalg.norm(np.cross(out, into)), out @ into))
    if distance <= NOTHING or angle > np.pi - REVERSAL:
        return Corner(0.0)
    return Corner(distance, corner.may_be_less, corner.may_stop)
