"""Pre-interpolator of PTP moves that blend into each other in joint space."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import Blend, MotionLaw
from irlx.diagnostics import Diagnostic, Place
from irlx.motion.chain_law import Stage, chain_law
from irlx.motion.joint_path import JointPath
from irlx.motion.plan_chain import lost_blend
from irlx.motion.plan_joint_line import (
    RAMP_TIME,
    PlannedJointLine,
    check_movable,
    joint_rates,
    plan_joint_line,
)
from irlx.motion.sections import RISE_TIME, Sections
from irlx.motion.time_law import TimeLaw
from irlx.motion.whole_ticks import ticks_of_move
from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]

SECTIONS = 8
"""Sections of a blend before its corner, and as many behind it, each with a speed of its own."""

_BEND_SHARE = 0.5
"""Part of a joint's acceleration that a blend may use up by its speed alone."""

_LEAST_SHARE = 1e-6


@dataclass(frozen=True)
class JointLeg:
    """A PTP to the posture `end` (n,), with the place of the move."""

    end: Array
    law: MotionLaw
    blend: Blend | None
    place: Place


@dataclass(frozen=True)
class JointJoin:
    """A blend at the end of the leg number `leg`; `s` is the path parameter at its corner.

    `used` is the part of half the shorter way, `miss` (n,) how far each joint stays off the posture of the
    corner when it is passed.
    """

    leg: int
    s: float
    used: float
    miss: Array


@dataclass(frozen=True)
class PlannedJointCurve:
    """Joint motion over a path, from rest to rest in `ticks` whole ticks."""

    path: JointPath
    law: TimeLaw
    ticks: int

    def postures(self, dt: float, rows: int | None = None) -> Array:
        """Joint values of ticks 1 .. ticks, shape (ticks, n), the last one exactly the end.

        With `rows` fewer of them (rows, n), spread evenly over the ticks.
        """
        count = self.ticks if rows is None else rows
        s, _ = self.law.evaluate(self.ticks / count * dt * np.arange(1.0, count + 1.0))
        s[-1:] = self.path.length
        q = self.path.q(s)
        still = np.all(self.path.postures == self.path.end, axis=0)
        q[:, still] = self.path.end[still]
        return q


@dataclass(frozen=True)
class PlannedJointChain:
    """The first stop-to-stop motion of a chain of PTP moves, which carries out `legs` of them.

    `ends`: path parameter at which each of these legs hands over to the next, the last one that of the end
    (1 where a single leg goes straight). `joins` are the blends, `notes` those that were asked for and lost.
    """

    motion: PlannedJointLine | PlannedJointCurve
    legs: int
    ends: tuple[float, ...]
    joins: tuple[JointJoin, ...]
    notes: tuple[Diagnostic, ...]


def plan_joint_chain(
    legs: Sequence[JointLeg], start: Array, limits: JointLimits, joint_names: tuple[str, ...], dt: float
) -> PlannedJointChain:
    """Plan as many PTP moves as blend into each other, from rest at the posture `start` (n,) to a stop.

    At least one leg. A single one is planned as `plan_joint_line` does it, and with its errors. A later one
    that cannot be planned ends the motion before it.
    """
    count, notes = _legs_of_first_motion(legs, start, limits)
    if count == 1:
        leg = legs[0]
        line = plan_joint_line(start, leg.end, leg.law, limits, joint_names, dt, leg.place)
        return PlannedJointChain(line, 1, (1.0,), (), notes)
    ways = _ways(legs[:count], start)
    for leg, way in zip(legs[:count], ways, strict=True):
        speed, acc = joint_rates(way, limits, leg.law)
        check_movable((way != 0.0) & ((speed == 0.0) | (acc == 0.0)), joint_names, leg.place)
    lengths = [_length(way, limits) for way in ways]
    distances = _distances(legs[:count], lengths)
    path, blended = _path(legs[:count], start, ways, lengths, distances)
    stages = _stages(path, blended, legs[:count], limits)
    law = chain_law(stages, path.length)
    ticks = ticks_of_move(law.duration, dt, legs[0].place)
    ends = np.cumsum([stage.length for stage in stages])
    ends[-1] = path.length
    motion = PlannedJointCurve(path, law.stretched(ticks * dt), ticks)
    return PlannedJointChain(
        motion, count, tuple(ends.tolist()), tuple(_joins(legs, path, ends, distances, lengths)), notes
    )


def _ways(legs: Sequence[JointLeg], start: Array) -> list[Array]:
    postures = [start, *(leg.end for leg in legs)]
    return [postures[k + 1] - postures[k] for k in range(len(legs))]


def _length(way: Array, limits: JointLimits) -> float:
    """Time (s) of a way at the full speed of its slowest joint: the path's parameter."""
    speed = np.where(way >= 0.0, limits.speed_upper, -limits.speed_lower)
    moving = way != 0.0
    with np.errstate(divide="ignore"):
        return float(np.max(np.abs(way[moving]) / speed[moving])) if np.any(moving) else 0.0


def _legs_of_first_motion(
    legs: Sequence[JointLeg], start: Array, limits: JointLimits
) -> tuple[int, tuple[Diagnostic, ...]]:
    """How many legs are one motion, and the note on the blend that ends it where one was asked for."""
    lengths = [_length(way, limits) for way in _ways(legs, start)]
    for k, (leg, following) in enumerate(pairwise(legs)):
        if leg.blend is None or leg.blend.share == 0.0:
            return k + 1, ()
        reason = _hindrance(lengths[k], lengths[k + 1], leg.blend)
        if reason:
            return k + 1, (lost_blend(leg.place, reason, following.place),)
    return len(legs), ()


def _hindrance(before: float, behind: float, blend: Blend) -> str:
    for length, name in ((before, "this move"), (behind, "the next move")):
        if length == 0.0:
            return f"{name} has no length, or no joint that moves has a speed limit"
        if not np.isfinite(length):
            return f"{name} needs a joint whose speed limit is 0"
    if blend.share is not None and blend.share < _LEAST_SHARE:
        return "C_PTP is next to nothing"
    return ""


def _distances(legs: Sequence[JointLeg], lengths: Sequence[float]) -> list[float]:
    """Path parameter from each corner to both ends of its blend."""
    return [
        0.5 * min(before, behind) * _share(leg.blend)
        for leg, before, behind in zip(legs[:-1], lengths[:-1], lengths[1:], strict=True)
    ]


def _share(blend: Blend | None) -> float:
    return 1.0 if blend is None or blend.share is None else min(blend.share, 1.0)


def _path(
    legs: Sequence[JointLeg],
    start: Array,
    ways: Sequence[Array],
    lengths: Sequence[float],
    distances: Sequence[float],
) -> tuple[JointPath, list[bool]]:
    """The path of all legs, and which of its pieces are blends."""
    rates = [way / length for way, length in zip(ways, lengths, strict=True)]
    corners = [start, *(leg.end for leg in legs)]
    around = [0.0, *distances, 0.0]
    rows: list[tuple[float, Array, Array, Array]] = []
    blended: list[bool] = []
    for k, rate in enumerate(rates):
        straight = lengths[k] - around[k] - around[k + 1]
        if straight > 0.0:
            rows.append((straight, corners[k] + around[k] * rate, rate, rate))
            blended.append(False)
        if k < len(distances):
            rows.append((2.0 * distances[k], corners[k + 1] - distances[k] * rate, rate, rates[k + 1]))
            blended.append(True)
    widths, postures, before, behind = (np.array(column) for column in zip(*rows, strict=True))
    return JointPath(widths, postures, before, behind, legs[-1].end), blended


def _stages(
    path: JointPath, blended: Sequence[bool], legs: Sequence[JointLeg], limits: JointLimits
) -> list[Stage]:
    """Bounds of every leg: its straight way, and the halves of the blends at its ends."""
    parts: list[list[Sections]] = [[]]
    for k, width in enumerate(path.widths):
        law = legs[len(parts) - 1].law
        if not blended[k]:
            parts[-1].append(_bounds(path, k, np.array([0.0, width]), law, limits))
            continue
        cuts = np.linspace(0.0, width, 2 * SECTIONS + 1)
        parts[-1].append(_bounds(path, k, cuts[: SECTIONS + 1], law, limits))
        parts.append([_bounds(path, k, cuts[SECTIONS:], legs[len(parts)].law, limits)])
    return [
        Stage(Sections.joined(sections), leg.law, leg.place)
        for sections, leg in zip(parts, legs, strict=True)
    ]


def _bounds(path: JointPath, k: int, cuts: Array, law: MotionLaw, limits: JointLimits) -> Sections:
    """Bounds between cuts (M + 1,) of the piece k within which every joint keeps its limits.

    |q'| ds/dt <= v, and |q''| (ds/dt)^2 + |q'| |d2s/dt2| <= a. Both derivatives are largest at one of the
    ends of a section: q' changes one way, |q''| rises up to the corner and falls behind it.
    """
    rate, bend = _derivatives(path, k, cuts)
    upper, lower = (np.maximum(side[:-1], side[1:]) for side in (rate, -rate))
    steep, bent = np.maximum(np.abs(upper), np.abs(lower)), np.maximum(np.abs(bend[:-1]), np.abs(bend[1:]))
    _, acc = joint_rates(np.ones_like(limits.speed_upper), limits, law)
    speeds = [joint_rates(sign * np.ones_like(acc), limits, law)[0] for sign in (1.0, -1.0)]
    acc = np.where(np.isfinite(acc), acc, np.minimum(*speeds) / RAMP_TIME)
    with np.errstate(divide="ignore", invalid="ignore"):
        fastest = np.minimum.reduce(
            [
                np.where(upper > 0.0, speeds[0] / upper, np.inf),
                np.where(lower > 0.0, speeds[1] / lower, np.inf),
                np.where(bent > 0.0, np.sqrt(_BEND_SHARE * acc / bent), np.inf),
            ]
        )
        speed = np.min(fastest, axis=1)
        left = acc - bent * speed[:, None] ** 2
        bound = np.min(np.where(steep > 0.0, left / steep, np.inf), axis=1)
    scale = law.override
    jerk = bound / RISE_TIME
    varying = np.full(len(cuts) - 1, len(cuts) > 2)
    return Sections(np.diff(cuts), speed * scale, bound * scale**2, jerk * scale**3, varying)


def _derivatives(path: JointPath, k: int, x: Array) -> tuple[Array, Array]:
    """First and second derivative, each (M, n), at the ways x (M,) on the piece k."""
    y = x / path.widths[k]
    change = path.behind[k] - path.before[k]
    rate = path.before[k] + (y * y * (3.0 - 2.0 * y))[:, None] * change
    return rate, (6.0 * y * (1.0 - y) / path.widths[k])[:, None] * change


def _joins(
    legs: Sequence[JointLeg],
    path: JointPath,
    ends: Array,
    distances: Sequence[float],
    lengths: Sequence[float],
) -> list[JointJoin]:
    passed = path.q(ends[:-1])
    return [
        JointJoin(
            k,
            float(ends[k]),
            2.0 * distance / min(lengths[k], lengths[k + 1]),
            np.abs(passed[k] - legs[k].end),
        )
        for k, distance in enumerate(distances)
    ]
