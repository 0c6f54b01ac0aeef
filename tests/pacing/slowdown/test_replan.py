"""A motion under way: planned anew, or braked to rest on its path, from any tick."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from irlx.motion.trapezoid import Trapezoid
from irlx.pacing.slowdown.clock import plan_clock
from irlx.pacing.slowdown.clock_bounds import clock_bounds
from irlx.pacing.slowdown.curve import JointCurve
from irlx.pacing.slowdown.replan import brake, replan
from irlx.robot.limits import JointLimits
from long_run import first

SPEED, ACCELERATION = 0.8, 4.0
LAW = Trapezoid.fastest(1.0, 0.5, 1.5)


def limits(joints: int, speed: float = SPEED) -> JointLimits:
    free = JointLimits.unlimited(joints)
    fast, hard = np.full(joints, speed), np.full(joints, ACCELERATION)
    return free.with_pair("speed", -fast, fast).with_pair("acceleration", -hard, hard)


def wavy(seed: int) -> JointCurve:
    """Three joints that swing over the path, so that speeds and accelerations bind in places."""
    print(f"seed {seed}")
    random = np.random.default_rng(seed)
    pieces = [np.linspace(*ends, 101)[1:] for ends in pairwise(LAW.corners)]
    s = np.concatenate([[0.0], *pieces])
    waves = [
        random.uniform(0.1, 0.5) * np.sin(random.uniform(2.0, 9.0) * s + random.uniform(0, 6)) for _ in "abc"
    ]
    return JointCurve(s, np.stack(waves, axis=1))


def shares(curve: JointCurve, clock, speed: float = SPEED) -> tuple[float, float]:
    """Largest use of speed and acceleration by dense samples of a clock, shares of the limits."""
    times = np.linspace(0.0, clock.duration, 6001)
    q = curve.at(clock.at(times)[0])
    rates = np.diff(q, axis=0) / times[1]
    return np.abs(rates).max() / speed, np.abs(np.diff(rates, axis=0)).max() / times[1] / ACCELERATION


@pytest.mark.req("MOT-10")
@pytest.mark.parametrize("seed", first(3, range(6)))
def test_a_plan_taken_up_anywhere_takes_the_time_that_was_left(seed) -> None:
    curve = wavy(seed)
    whole = plan_clock(clock_bounds(curve, limits(3), LAW.rates_at(curve.s), LAW.acc))
    for time in np.random.default_rng(seed).uniform(0.0, whole.duration, 25):
        s, rate = (float(value[0]) for value in whole.at(np.array([time])))
        rest = replan(curve, limits(3), LAW, LAW.acc, s, rate)
        assert rest.s[0] == s
        assert rest.x[0] == pytest.approx(rate**2)
        assert rest.duration == pytest.approx(whole.duration - time, abs=2e-3 * whole.duration)
        assert max(shares(curve, rest)) <= 1.0 + 1e-3


@pytest.mark.req("MOT-10")
@pytest.mark.parametrize("seed", first(3, range(6)))
def test_a_motion_can_always_brake_to_rest_on_its_path(seed) -> None:
    curve = wavy(seed)
    whole = plan_clock(clock_bounds(curve, limits(3), LAW.rates_at(curve.s), LAW.acc))
    for time in np.random.default_rng(seed).uniform(0.0, whole.duration, 25):
        s, rate = (float(value[0]) for value in whole.at(np.array([time])))
        stop = brake(curve, limits(3), LAW, LAW.acc, s, rate)
        assert stop.x[-1] == 0.0
        assert stop.s[-1] <= 1.0
        assert stop.duration <= whole.duration - time + 2e-3 * whole.duration
        assert max(shares(curve, stop)) <= 1.0 + 1e-3
        # Braking harder than the law or a joint allows would stop sooner.
        assert stop.s[-1] - s >= rate**2 / (2.0 * LAW.acc) * (1.0 - 1e-6) - 1e-12


def test_new_limits_hold_from_the_place_on() -> None:
    """A joint that may go half as fast from here on: the rest is planned for that, or it is too late."""
    s = np.linspace(0.0, 1.0, 201)
    curve = JointCurve(s, s[:, None])
    rest = replan(curve, limits(1, 0.25), LAW, LAW.acc, 0.3, 0.2)
    assert shares(curve, rest, 0.25)[0] <= 1.0 + 1e-9
    assert replan(curve, limits(1, 0.25), LAW, LAW.acc, 0.3, 0.3) is None
