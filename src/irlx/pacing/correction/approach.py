"""How a correction runs towards its request: straight, with bounded speed and acceleration, no overshoot."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.correction.tool_rates import ToolRates
from irlx.robot.limits import JointLimits
from irlx.transform.step_bounds import BoundSource, braking_speed

Array = NDArray[np.float64]

JOINT_PART = 0.5
"""Part of what the joints have for corrections that a correction's own way may take; the rest is for what
the joints have to do so that a correction stays as it is while the arm moves on."""

BRAKING_PART = 0.8
"""Part of the acceleration with which braking is planned: the arm may brake less well further on."""


class Governor(NamedTuple):
    """What decides how fast a correction changes: a joint's bound; joint -1 for the tool's own rates.

    Joint -2 where something would come too near, whatever the source says.
    """

    joint: int
    source: BoundSource


TOOL = -1
TOO_NEAR = Governor(-2, BoundSource.POSITION)


@dataclass(frozen=True)
class Pace:
    """What a rate of the correction costs: `joint_rates` (n, 6) joint speeds per unit of it.

    `limits` are those of corrections, `rates` the tool's own.
    """

    joint_rates: Array
    limits: JointLimits
    rates: ToolRates

    def speed(self, direction: Array) -> tuple[float, Governor]:
        """Most speed along a unit vector (6,), and what decides it."""
        joints = self._joints(direction, self.limits.speed_lower, self.limits.speed_upper)
        tool = _tool(direction, self.rates.speed, self.rates.speed_ori)
        if tool <= joints[0]:
            return tool, Governor(TOOL, BoundSource.SPEED)
        return joints[0], Governor(joints[1], BoundSource.SPEED)

    def acceleration(self, direction: Array) -> tuple[float, Governor]:
        """Most acceleration along a unit vector (6,), forwards and backwards, and what decides it."""
        lower, upper = self.limits.acceleration_lower, self.limits.acceleration_upper
        most = np.minimum(-lower, upper)
        joints = self._joints(direction, -most, most)
        tool = _tool(direction, self.rates.acceleration, self.rates.acceleration_ori)
        if tool <= joints[0]:
            return tool, Governor(TOOL, BoundSource.ACCELERATION)
        return joints[0], Governor(joints[1], BoundSource.ACCELERATION)

    def _joints(self, direction: Array, lower: Array, upper: Array) -> tuple[float, int]:
        needed = self.joint_rates @ direction
        allowed = np.where(needed > 0.0, upper, -lower)
        moving = np.abs(needed) > 0.0
        most = np.divide(allowed, np.abs(needed), out=np.full(needed.size, np.inf), where=moving)
        joint = int(np.argmin(most))
        return JOINT_PART * float(most[joint]), joint


def _tool(direction: Array, linear: float, angular: float) -> float:
    shares = [(linear, np.linalg.norm(direction[:3])), (angular, np.linalg.norm(direction[3:]))]
    return min((float(most / part) for most, part in shares if part > 0.0), default=inf)


class Approach(NamedTuple):
    """A correction (6,) one tick further, its rate (6,) per s, and what keeps it from the request."""

    correction: Array
    rate: Array
    governor: Governor


def approach(correction: Array, rate: Array, request: Array, pace: Pace, dt: float) -> Approach:
    """One tick of the way from a correction at a rate to the request, by the bounds of `pace`.

    The wanted speed points straight to the request and is one from which whole ticks of braking stop there;
    the rate changes towards it by no more than the acceleration allows. Where it ends, the correction is the
    request bit by bit.
    """
    away = request - correction
    distance = float(np.linalg.norm(away))
    direct, wanted, governor = True, np.zeros(6), Governor(TOOL, BoundSource.SPEED)
    if distance > 0.0:
        direction = away / distance
        most, governor = pace.speed(direction)
        able, _ = pace.acceleration(direction)
        stopping = float(braking_speed(np.array([distance]), np.array([BRAKING_PART * able]), dt)[0])
        speed = min(most, stopping)
        direct = distance <= speed * dt * (1.0 + 1e-12)
        wanted = away / dt if direct else direction * speed
    change = wanted - rate
    size = float(np.linalg.norm(change))
    if size > 0.0:
        able, brake = pace.acceleration(change / size)
        if size > able * dt:
            further = rate + change * (able * dt / size)
            return Approach(correction + further * dt, further, brake)
    if direct:
        return Approach(request.copy(), wanted, governor)
    return Approach(correction + wanted * dt, wanted, governor)
