"""Pre-interpolator of PTP: all joints start and stop together, straight in joint space."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import MotionLaw
from irlx.diagnostics import Place, report
from irlx.motion.errors import MotionError
from irlx.motion.trapezoid import Trapezoid
from irlx.motion.whole_ticks import ticks_of_move
from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]

RAMP_TIME = 0.2
"""Ramp of a joint whose acceleration limit is not known, s: it reaches its speed in this time."""

RESERVE = 1e-6
"""Part of every joint limit left unused, so that rounding of differences stays inside."""

_TIME_SLACK = 1e-9
_RAMP_SHARE = 0.25


@dataclass(frozen=True)
class PlannedJointLine:
    """Joint motion q(t) = start + u(t) (end - start), u from 0 to 1 over `ticks` whole ticks."""

    start: Array
    end: Array
    law: Trapezoid
    ticks: int

    def postures(self, dt: float, rows: int | None = None) -> Array:
        """Joint values of ticks 1 .. ticks, shape (ticks, n), the last one exactly the end.

        With `rows` fewer of them (rows, n), spread evenly over the ticks.
        """
        rows = self.ticks if rows is None else rows
        share, _ = self.law.evaluate(self.ticks / rows * dt * np.arange(1.0, rows + 1.0))
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

    SPEED_PTP and ACC_PTP scale the joints' limits. Raises MotionError: IRL421 where TIME is too
    short, IRL423 where a joint that moves has no speed limit and TIME is not given, IRL426 where a joint
    that would move has a speed or acceleration limit of 0, IRL425 where it would take too long.
    """
    way = end - start
    if not np.any(way):
        return PlannedJointLine(start, end, Trapezoid(0.0, 0.0, 0.0, 0.0), 0)
    speed, acc = _joint_rates(way, limits)
    speed, acc = speed * law.speed_ptp * (1.0 - RESERVE), acc * law.acc_ptp * (1.0 - RESERVE)
    moving = way != 0.0
    _check_movable(moving & ((speed == 0.0) | (acc == 0.0)), joint_names, place)
    rate = float(np.min(speed[moving] / np.abs(way[moving])))
    bound = float(np.min(acc[moving] / np.abs(way[moving])))
    if not np.isfinite(rate) and np.isfinite(bound):
        trapezoid = Trapezoid.fastest(1.0, rate, bound)
    elif not np.isfinite(rate):
        if law.duration is None:
            joint = joint_names[int(np.flatnonzero(moving)[0])]
            raise MotionError(report("IRL423", place, joint=joint))
        ramp = _RAMP_SHARE * law.duration
        trapezoid = Trapezoid(1.0, 1.0 / (law.duration - ramp), ramp, law.duration - 2.0 * ramp)
    else:
        acc = np.where(np.isfinite(acc), acc, speed / RAMP_TIME)
        trapezoid = Trapezoid.fastest(1.0, rate, float(np.min(acc[moving] / np.abs(way[moving]))))
    trapezoid = _with_duration(trapezoid, law, place)
    ticks = ticks_of_move(trapezoid.duration, dt, place)
    return PlannedJointLine(start, end, trapezoid.stretched(ticks * dt), ticks)


def _joint_rates(way: Array, limits: JointLimits) -> tuple[Array, Array]:
    """Speed and acceleration each joint may use on its way; ramps need both signs of acceleration."""
    speed = np.where(way >= 0.0, limits.speed_upper, -limits.speed_lower)
    return speed, np.minimum(limits.acceleration_upper, -limits.acceleration_lower)


def _check_movable(held: NDArray[np.bool_], joint_names: tuple[str, ...], place: Place) -> None:
    if np.any(held):
        joint = joint_names[int(np.flatnonzero(held)[0])]
        raise MotionError(report("IRL426", place, joint=joint))


def _with_duration(fastest: Trapezoid, law: MotionLaw, place: Place) -> Trapezoid:
    if law.duration is None:
        return fastest
    if law.duration < fastest.duration * (1.0 - _TIME_SLACK):
        data: dict[str, Any] = {"asked": f"{law.duration:.6g}", "least": f"{fastest.duration:.6g}"}
        raise MotionError(report("IRL421", place, governor="the joints' limits", **data))
    return fastest.stretched(law.duration)
