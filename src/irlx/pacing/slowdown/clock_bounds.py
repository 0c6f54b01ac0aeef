"""What a clock on a curve q(s) must keep, written in x = (ds/dt)^2 and u = d2s/dt2.

With x_i at knot i and u constant in the interval behind it, x(s) = x_i + 2 u (s - s_i) and

    qd = q' sqrt(x),    qdd = q' u + q'' x = (q' + 2 (s - s_i) q'') u + q'' x_i.

Speeds bound x; accelerations, taken at five points of every interval, are straight lines in (x_i, u).
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.slowdown.curve import JointCurve
from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]
Joints = NDArray[np.int16]

_FRACTIONS = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
_NO_SLOPE = 1e-10
_CHUNK = 64

PATH = -1
"""Stands for the path itself where a joint's number (from 0) is expected."""


class Reserves(NamedTuple):
    """Parts of the speed and acceleration bounds that a clock leaves unused."""

    speed: float
    acceleration: float


PLANNED = Reserves(1e-5, 1e-3)
"""Reserves of a motion's first clock."""


class Governor(IntEnum):
    """What bounds the rate at a knot: the programme, a joint's speed, or a joint's acceleration."""

    PROGRAM = 0
    SPEED = 1
    ACCELERATION = 2


@dataclass(frozen=True)
class ClockBounds:
    """Bounds of a clock over N intervals between knots `s` (N + 1,).

    x at the knots is at most `cap` (N + 1,), for the reason `governor` and `joint` (N + 1,) tell. In
    each interval u <= top + slope x_i and u >= bottom + slope x_i, lines (N, K), column k of joint
    `line_joint[k]`; bottom <= 0 <= top, so that standstill is always allowed.
    """

    s: Array
    cap: Array
    governor: NDArray[np.int8]
    joint: Joints
    top: Array
    bottom: Array
    slope: Array
    line_joint: Joints

    def part(self, first: int, last: int) -> ClockBounds:
        """Bounds between two knots."""
        knots, intervals = slice(first, last + 1), slice(first, last)
        return ClockBounds(
            self.s[knots],
            self.cap[knots],
            self.governor[knots],
            self.joint[knots],
            self.top[intervals],
            self.bottom[intervals],
            self.slope[intervals],
            self.line_joint,
        )


def clock_bounds(
    curve: JointCurve,
    limits: JointLimits,
    rates: Array,
    acc: float | Array,
    knots: Array | None = None,
    reserves: Reserves = PLANNED,
) -> ClockBounds:
    """Bounds on a curve under joint limits, a programmed rate ds/dt (N + 1,), and |d2s/dt2| <= acc, (N,) or
    the same everywhere.

    `knots` (N + 1,) of the clock are those of the curve where they are not given; `reserves` are kept for
    what happens between the points.
    """
    s = curve.s if knots is None else knots
    widths = np.diff(s)
    at = (s[:-1, None] + widths[:, None] * _FRACTIONS).ravel()
    shape = (widths.size, _FRACTIONS.size, curve.q.shape[1])
    first, second = (part.reshape(shape) for part in curve.derivatives(at))
    cap, governor, joint = _speed_caps(first, limits, rates, reserves.speed)
    lines = _lines(first, second, widths, limits, acc, reserves.acceleration)
    _lower_cap(cap, governor, joint, *lines[4:], Governor.ACCELERATION)
    top, bottom, slope, line_joint = lines[:4]
    _lower_cap(cap, governor, joint, *_meeting_points(top, bottom, slope, line_joint), Governor.ACCELERATION)
    return ClockBounds(s, cap, governor, joint, top, bottom, slope, line_joint)


def _speed_caps(
    first: Array, limits: JointLimits, rates: Array, reserve: float
) -> tuple[Array, NDArray[np.int8], Joints]:
    """x at the knots by the programmed rate and by the joints' speeds in both intervals beside a knot."""
    keep = 1.0 - reserve
    fastest = np.where(first > 0.0, limits.speed_upper, -limits.speed_lower) * keep
    steep = np.abs(first)
    # A joint that rests moves by rounding alone; where it may not go that way, that would stop the clock.
    steep = np.where(steep > _NO_SLOPE * np.max(steep), steep, 0.0)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        squares = np.where(steep > 0.0, fastest / steep, np.inf) ** 2
    of_joint = squares.min(axis=1)
    worst = np.argmin(of_joint, axis=1)
    lowest = of_joint[np.arange(len(worst)), worst]
    cap, joint = rates**2, np.full(rates.size, PATH, dtype=np.int16)
    governor = np.zeros(rates.size, dtype=np.int8)
    _lower_cap(cap, governor, joint, lowest, worst.astype(np.int16), Governor.SPEED)
    _lower_cap(cap[1:], governor[1:], joint[1:], lowest, worst.astype(np.int16), Governor.SPEED)
    return cap, governor, joint


def _lower_cap(
    cap: Array, governor: NDArray[np.int8], joint: Joints, values: Array, joints: Joints, why: Governor
) -> None:
    """Lower the caps of the first knots to `values` where these are less; changes the arrays in place."""
    less = np.flatnonzero(values < cap[: len(values)])
    cap[less], governor[less], joint[less] = values[less], why, joints[less]


def _lines(
    first: Array, second: Array, widths: Array, limits: JointLimits, acc: float | Array, reserve: float
) -> tuple[Array, Array, Array, Joints, Array, Joints]:
    """top, bottom, slope (N, K), joint (K,) of the lines; x by points that only bend, its joint (N,)."""
    intervals, points, joints = first.shape
    keep = 1.0 - reserve
    low, high = limits.acceleration_lower * keep, limits.acceleration_upper * keep
    way = first + 2.0 * (widths[:, None] * _FRACTIONS)[:, :, None] * second
    flat = np.abs(way) <= _NO_SLOPE * (np.max(np.abs(way)) + 1e-300)
    safe = np.where(flat, 1.0, way)
    top = np.where(flat, np.inf, np.where(safe > 0.0, high, low) / safe)
    bottom = np.where(flat, -np.inf, np.where(safe > 0.0, low, high) / safe)
    slope = np.where(flat, 0.0, -second / safe)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        bend = np.where(second > 0.0, high / second, np.where(second < 0.0, low / second, np.inf))
    bend = np.where(flat, bend, np.inf).reshape(intervals, -1)
    worst = np.argmin(bend, axis=1)
    number = np.tile(np.arange(joints), points)
    known = np.isfinite(low[number]) | np.isfinite(high[number])
    own = np.broadcast_to(np.reshape(acc, (-1, 1)), (intervals, 1)).astype(np.float64)
    flatten = [part.reshape(intervals, -1)[:, known] for part in (top, bottom, slope)]
    return (
        np.hstack([flatten[0], own]),
        np.hstack([flatten[1], -own]),
        np.hstack([flatten[2], np.zeros_like(own)]),
        np.append(number[known], PATH).astype(np.int16),
        bend[np.arange(intervals), worst],
        (worst % joints).astype(np.int16),
    )


def _meeting_points(top: Array, bottom: Array, slope: Array, line_joint: Joints) -> tuple[Array, Joints]:
    """Largest x (N,) at which some u lies below all tops and above all bottoms, and the joint to blame."""
    intervals, lines = top.shape
    largest, joint = np.full(intervals, np.inf), np.full(intervals, PATH, dtype=np.int16)
    for start in range(0, intervals, _CHUNK):
        part = slice(start, start + _CHUNK)
        # Line l rises towards line k from below where its slope is the larger one.
        rise = slope[part, None, :] - slope[part, :, None]
        room = top[part, :, None] - bottom[part, None, :]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            meet = np.where(rise > 0.0, room / rise, np.inf).reshape(len(rise), -1)
        # A top and a bottom at infinity meet nowhere.
        meet = np.where(np.isnan(meet), np.inf, meet)
        worst = np.argmin(meet, axis=1)
        largest[part] = meet[np.arange(len(meet)), worst]
        upper, lower = line_joint[worst // lines], line_joint[worst % lines]
        joint[part] = np.where(upper == PATH, lower, upper)
    return largest, joint
