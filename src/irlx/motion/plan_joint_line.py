"""Pre-interpolator of PTP: all joints start and stop together, straight in joint space."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import MotionLaw, Profile
from irlx.diagnostics import Place, report
from irlx.motion.errors import MotionError
from irlx.motion.fastest_law import fastest_s_curves
from irlx.motion.plan_path import with_time
from irlx.motion.sections import RISE_TIME, Sections
from irlx.motion.time_law import TimeLaw
from irlx.motion.trapezoid import Trapezoid
from irlx.motion.whole_ticks import ticks_of_move
from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]

RAMP_TIME = 0.2
"""Ramp of a joint whose acceleration limit is not known, s: it reaches its speed in this time."""

RESERVE = 1e-6
"""Part of every joint limit left unused, so that rounding of differences stays inside."""

_RAMP_SHARE = 0.25


@dataclass(frozen=True)
class PlannedJointLine:
    """Joint motion q(t) = start + u(t) (end - start), u from 0 to 1 over `ticks` whole ticks."""

    start: Array
    end: Array
    law: TimeLaw
    ticks: int

    def postures(self, dt: float, rows: int | None = None) -> Array:
        """Joint values of ticks 1 .. ticks, shape (ticks, n), the last one exactly the end.

        With `rows` fewer of them (rows, n), spread evenly over the ticks.
        """
        rows = self.ticks if rows is None else rows
        share, _ = self.law.evaluate(self.ticks / max(rows, 1) * dt * np.arange(1.0, rows + 1.0))
        share[-1:] = 1.0
        q = self.start + share[:, None] * (self.end - self.start)
        q[-1:] = self.end
        still = self.start == self.end
        # -0.0 + 0.0 is 0.0: a joint that does not move keeps its very bits.
        q[:, still] = self.start[still]
        return np.asarray(q)


def plan_joint_line(
    start: Array,
    end: Array,
    law: MotionLaw,
    limits: JointLimits,
    joint_names: tuple[str, ...],
    dt: float,
    place: Place,
) -> PlannedJointLine:
    """Plan the motion between two postures (n,) under the speed and acceleration limits in force.

    SPEED_PTP and ACC_PTP scale the joints' limits; an S curve reaches the acceleration in `RISE_TIME`. TIME
    stretches the motion, then OVERRIDE. Raises MotionError: IRL421 where TIME is too
    short, IRL423 where a joint that moves has no speed limit and TIME is not given, IRL426 where a joint
    that would move has a speed or acceleration limit of 0, IRL425 where it would take too long.
    """
    way = end - start
    if not np.any(way):
        return PlannedJointLine(start, end, Trapezoid(0.0, 0.0, 0.0, 0.0), 0)
    speed, acc = joint_rates(way, limits, law)
    moving = way != 0.0
    check_movable(moving & ((speed == 0.0) | (acc == 0.0)), joint_names, place)
    rate = float(np.min(speed[moving] / np.abs(way[moving])))
    bound = float(np.min(acc[moving] / np.abs(way[moving])))
    if not np.isfinite(rate) and np.isfinite(bound):
        fastest = _fastest(rate, bound, law)
    elif not np.isfinite(rate):
        if law.duration is None:
            joint = joint_names[int(np.flatnonzero(moving)[0])]
            raise MotionError(report("IRL423", place, joint=joint))
        fastest = _unhurried(law.duration, law)
    else:
        acc = np.where(np.isfinite(acc), acc, speed / RAMP_TIME)
        fastest = _fastest(rate, float(np.min(acc[moving] / np.abs(way[moving]))), law)
    timed = with_time(fastest, law, place, lambda: "the joints' limits")
    timed = timed if law.override == 1.0 else timed.stretched(timed.duration / law.override)
    ticks = ticks_of_move(timed.duration, dt, place)
    return PlannedJointLine(start, end, timed.stretched(ticks * dt), ticks)


def joint_rates(way: Array, limits: JointLimits, law: MotionLaw) -> tuple[Array, Array]:
    """Speed and acceleration (n,) each joint may use on its way; ramps need both signs of acceleration."""
    speed = np.where(way >= 0.0, limits.speed_upper, -limits.speed_lower)
    acc = np.minimum(limits.acceleration_upper, -limits.acceleration_lower)
    return speed * law.speed_ptp * (1.0 - RESERVE), acc * law.acc_ptp * (1.0 - RESERVE)


def _fastest(rate: float, bound: float, law: MotionLaw) -> TimeLaw:
    """Law of the share 0..1 within a speed and an acceleration."""
    if law.profile is Profile.TRAPEZOID:
        return Trapezoid.fastest(1.0, rate, bound)
    # No way of 1 needs a larger rate than its acceleration reaches; an infinite one has no S curve.
    rate = min(rate, 2.0 * float(np.sqrt(bound)))
    return fastest_s_curves(Sections(*(np.array([v]) for v in (1.0, rate, bound, bound / RISE_TIME))), 1.0)


def _unhurried(duration: float, law: MotionLaw) -> TimeLaw:
    """Law of the share 0..1 in a time of which each ramp takes a quarter: where no limit is known."""
    ramp = _RAMP_SHARE * duration
    rate = 1.0 / (duration - ramp)
    trapezoid = Trapezoid(1.0, rate, ramp, duration - 2.0 * ramp)
    return (
        trapezoid
        if law.profile is Profile.TRAPEZOID
        else _fastest(rate, rate / ramp, law).stretched(duration)
    )


def check_movable(held: NDArray[np.bool_], joint_names: tuple[str, ...], place: Place) -> None:
    """Raise MotionError, IRL426, for the first joint (n,) that is to move and cannot."""
    if np.any(held):
        joint = joint_names[int(np.flatnonzero(held)[0])]
        raise MotionError(report("IRL426", place, joint=joint))
