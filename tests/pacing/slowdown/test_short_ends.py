"""Ramps of slowed motions against the closed form of a trapezoid, and against their bounds in time."""

import numpy as np
import pytest

from irlx.motion.fastest_law import fastest_trapezoids
from irlx.motion.sections import Sections
from irlx.motion.trapezoid import Trapezoid
from irlx.pacing.slowdown.clock import plan_clock
from irlx.pacing.slowdown.clock_bounds import clock_bounds
from irlx.pacing.slowdown.curve import JointCurve
from irlx.pacing.slowdown.grid import acc_between
from irlx.pacing.slowdown.short_ends import with_short_ends

pytestmark = pytest.mark.req("MOT-21")

LAW = Trapezoid.fastest(0.3, 1.0, 3.0)
"""Programmed: knots are 4 mm apart, run through in 4 ms."""


def curve_of(bend: float = 0.0) -> JointCurve:
    """Two joints over 0.3 m, the second one on an arc where it bends."""
    s = np.linspace(0.0, 0.3, 76)
    return JointCurve(s, np.column_stack([s, bend * s**2]))


def planned(curve: JointCurve, lim, law=LAW):
    rates = law.rates_at(curve.s)
    clock = plan_clock(clock_bounds(curve, lim, rates, law.acc))
    return clock, with_short_ends(clock, curve, lim, rates, law.rates_at, law.acc)


@pytest.mark.parametrize("speed", [0.03, 0.003])
@pytest.mark.parametrize(("up", "down"), [(1.0, 1.0), (0.5, 2.0), (100.0, 100.0)])
def test_a_line_slowed_very_much_is_a_trapezoid(tools, speed: float, up: float, down: float) -> None:
    """Its ramps end within 0.9 mm; over all of an interval they lost 0.13 s each at 0.03 m/s."""
    lim = tools.limits(2, [speed, 9.0], up, hardest=-down)
    before, clock = planned(curve_of(), lim)
    up, down = min(up, LAW.acc), min(down, LAW.acc)
    wanted = 0.3 / speed + 0.5 * speed * (1.0 / up + 1.0 / down)
    assert before.duration > wanted * 1.01
    assert wanted <= clock.duration < wanted * 1.001


@pytest.mark.req("MOT-03")
@pytest.mark.parametrize(("first", "last"), [(0.5, 2.0), (2.0, 0.5)])
def test_joined_moves_have_ramps_by_their_own_acc(tools, first: float, last: float) -> None:
    """Joints would allow more: the first move says how the tool speeds up, the last one how it brakes."""
    curve, lim, speed = curve_of(), tools.limits(2, [0.03, 9.0], 100.0), 0.03
    halves = Sections(np.full(2, 0.15), np.ones(2), np.array([first, last]), np.full(2, np.inf))
    law = fastest_trapezoids(halves, 0.3)
    rates, acc = law.rates_at(curve.s), acc_between(law, curve.s)
    before = plan_clock(clock_bounds(curve, lim, rates, acc))
    clock = with_short_ends(before, curve, lim, rates, law.rates_at, acc)
    wanted = 0.3 / speed + 0.5 * speed * (1.0 / first + 1.0 / last)
    assert before.duration > wanted * 1.01
    assert wanted <= clock.duration < wanted * 1.001
    gained = 0.5 * np.diff(clock.x) / np.diff(clock.s)
    assert np.max(gained) <= first * (1.0 + 1e-9)
    assert np.min(gained) >= -last * (1.0 + 1e-9)


@pytest.mark.parametrize("speed", [1.0, 0.4])
def test_ramps_of_many_intervals_stay_to_the_bit(tools, speed: float) -> None:
    before, clock = planned(curve_of(), tools.limits(2, speed, 2.0))
    assert clock is before


@pytest.mark.parametrize("speed", [0.03, 0.05])
def test_all_bounds_hold_on_the_shorter_ramps(tools, speed: float) -> None:
    """Joint speeds and accelerations by differences over 20 us."""
    curve, lim = curve_of(bend=3.0), tools.limits(2, speed, [1.0, 0.4])
    before, clock = planned(curve, lim)
    assert clock.duration < before.duration
    h = 2e-5
    q = curve.at(clock.at(np.arange(0.0, clock.duration, h))[0])
    v, a = np.diff(q, axis=0) / h, np.diff(q, 2, axis=0) / h**2
    assert np.all(np.abs(v) <= lim.speed_upper)
    assert np.all(np.abs(a) <= lim.acceleration_upper * (1.0 + 1e-6) + 1e-6)


@pytest.mark.req("MOT-20")
def test_the_programmed_rate_is_never_passed(tools) -> None:
    """A programme that speeds up more gently than the joints could: its own ramp is the shortest."""
    law = Trapezoid.fastest(0.3, 1.0, 0.5)
    _, clock = planned(curve_of(), tools.limits(2, 0.03, 50.0), law)
    assert np.all(clock.x <= law.rates_at(clock.s) ** 2 * (1.0 + 1e-12))
    assert np.all(np.abs(np.diff(clock.x)) <= 2.0 * law.acc * np.diff(clock.s) * (1.0 + 1e-9))
