"""Slowed clocks of S curves: jerk and joint bounds by differences in time, durations against closed forms."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
import scipy.optimize
from scipy.sparse import csr_matrix

from irlx.motion.fastest_law import fastest_s_curves, fastest_trapezoids
from irlx.motion.sections import Sections
from irlx.pacing.slowdown.clock import plan_clock
from irlx.pacing.slowdown.clock_bounds import clock_bounds
from irlx.pacing.slowdown.curve import JointCurve
from irlx.pacing.slowdown.planned import PlannedMotion, plan_motion
from irlx.pacing.slowdown.smooth_clock import SmoothRate, _lines, _with_more
from machines import machine
from slow_cases import SPEEDS, WAYS, slow_limits
from stream_judge import excess

pytestmark = pytest.mark.req("MOT-20")

WAY, SPEED, ACC, JERK = 0.3, 0.2, 0.8, 4.0


def s_curve(way: float = WAY, jerk: float = JERK):
    bounds = ([way], [SPEED], [ACC], [jerk])
    return fastest_s_curves(Sections(*(np.array(value) for value in bounds)), way)


def curve_of(bend: float) -> JointCurve:
    """Two joints, the second one on a wave where it bends."""
    s = np.linspace(0.0, WAY, 376)
    return JointCurve(s, np.column_stack([s, bend * np.sin(40.0 * s)]))


def sampled(clock, dt: float) -> np.ndarray:
    """s of a clock every dt, rest before and behind."""
    times = dt * np.arange(-4.0, np.ceil(clock.duration / dt) + 5.0)
    return clock.at(np.clip(times, 0.0, clock.duration))[0]


@pytest.mark.parametrize("dt", [0.01, 0.002])
@pytest.mark.parametrize(("speed", "acc"), [(0.05, 9.0), (9.0, 0.25), (0.09, 0.6)])
def test_a_slowed_clock_keeps_jerk_and_joint_bounds(tools, dt: float, speed: float, acc: float) -> None:
    """And costs little beside the fastest clock that keeps no jerk."""
    curve, lim, law = curve_of(0.02), tools.limits(2, [9.0, speed], acc), s_curve()
    clock = SmoothRate(law, law.acc, 0.5 * dt).clock(curve, lim)
    assert clock is not None
    rough = plan_clock(clock_bounds(curve, lim, law.rates_at(curve.s), law.acc))
    assert law.duration < rough.duration < clock.duration < 1.15 * rough.duration
    s = sampled(clock, dt)
    assert np.max(np.abs(np.diff(s, 3))) / dt**3 < JERK * 1.03
    assert np.max(np.abs(np.diff(sampled(rough, dt), 3))) / dt**3 > JERK * 2.0
    q = curve.at(s)
    assert np.max(np.abs(np.diff(q, axis=0)), axis=0)[1] / dt <= speed
    assert np.max(np.abs(np.diff(q, 2, axis=0))) / dt**2 <= acc
    assert np.all(np.sqrt(clock.x) <= law.rates_at(clock.s) * (1.0 + 1e-9))


@pytest.mark.parametrize("top", [0.15, 0.06, 0.02])
def test_a_line_slowed_evenly_is_the_s_curve_of_its_speed(tools, top: float) -> None:
    """Rise and fall take 2 sqrt(v / j), or v / a + a / j where the acceleration is reached."""
    clock = SmoothRate(s_curve(), ACC, 0.002).clock(curve_of(0.0), tools.limits(2, [top, 9.0], 99.0))
    assert clock is not None
    ramp = 2.0 * np.sqrt(top / JERK) if top * JERK < ACC**2 else top / ACC + ACC / JERK
    wanted = WAY / top + ramp
    assert wanted * 0.9999 < clock.duration < wanted * 1.005


def test_what_nothing_slows_runs_as_programmed(tools) -> None:
    """On the knots of the joints, 4 ms apart at full speed, its ramps were too short."""
    law, dt = s_curve(), 0.005
    curve, lim = curve_of(0.0), tools.limits(2, 9.0, 99.0)
    rough = plan_clock(clock_bounds(curve, lim, law.rates_at(curve.s), ACC))
    clock = SmoothRate(law, ACC, 0.5 * dt).clock(curve, lim)
    assert clock is not None
    assert rough.duration < law.duration - 0.05
    assert clock.duration == pytest.approx(law.duration, abs=0.5 * dt)
    assert np.max(np.abs(np.diff(sampled(clock, dt), 3))) / dt**3 < JERK * 1.01


@pytest.mark.parametrize(("ever_steeper", "speed", "acc"), [(False, 0.09, 0.6), (True, 9.0, 0.3)])
def test_without_an_answer_of_the_program_the_whole_law_is_slower(
    tools, monkeypatch, ever_steeper: bool, speed: float, acc: float
) -> None:
    curve, lim, law, dt = curve_of(0.02), tools.limits(2, [9.0, speed], [9.0, acc]), s_curve(), 0.005
    if ever_steeper:
        curve = JointCurve(curve.s, np.column_stack([curve.s, 0.02 * np.exp(8.0 * curve.s)]))
    monkeypatch.setattr(scipy.optimize, "linprog", lambda *_, **__: SimpleNamespace(status=4))
    clock = SmoothRate(law, law.acc, 0.5 * dt).clock(curve, lim)
    assert clock is not None
    s = sampled(clock, dt)
    assert np.max(np.abs(np.diff(s, 3))) / dt**3 < JERK * 1.01
    q = curve.at(s)
    assert np.max(np.abs(np.diff(q, axis=0)), axis=0)[1] / dt <= speed
    found = np.max(np.abs(np.diff(q, 2, axis=0)), axis=0)[1] / dt**2
    assert found <= acc
    assert found > 0.97 * acc or not ever_steeper


def test_lines_that_are_left_out_bound_nothing() -> None:
    """What is least at both ends of an interval's x is so in between, and each line is kept but once."""
    rng, n, count = np.random.default_rng(5), 40, 6
    side, slope = rng.uniform(0.5, 2.0, (n, count)), rng.uniform(0.1, 2.0, (n, count))
    side[:, 1], slope[:, 1] = side[:, 0], slope[:, 0]
    side[::3, 2] = np.inf
    x = rng.uniform(0.1, 1.0, n + 1)
    for sign in (1.0, -1.0):
        lines, room = _lines(csr_matrix((n, n + 1)), side, sign, slope, x)
        interval = lines.indices
        assert len(interval) == len(room) < 0.6 * side.size
        at_most = room - lines.data
        for k in range(n):
            kept = interval == k
            assert np.min(room[kept]) == np.min(side[k])
            full = side[k] + sign * slope[k] * x[k]
            assert np.min(at_most[kept]) == pytest.approx(np.min(full), rel=1e-14)
        assert len(set(zip(interval.tolist(), room.tolist(), strict=True))) == len(room)


@pytest.mark.parametrize("way", [0.01, 100.0])
def test_knots_that_differ_by_a_rounding_are_one(way: float) -> None:
    knots = way * np.array([0.0, 0.5, 1.0])
    found = _with_more(knots, way * np.array([0.25, 0.5 + 5e-14, 0.75, 0.75 + 2e-13, 1.0 - 5e-14]))
    np.testing.assert_allclose(found / way, [0.0, 0.25, 0.5, 0.75, 0.75 + 2e-13, 1.0], rtol=0, atol=1e-13)
    assert (len(found), found[-1]) == (6, way)


def test_only_laws_that_bound_it_have_a_jerk_to_keep() -> None:
    bounds = Sections(*(np.array([value]) for value in (WAY, SPEED, ACC, JERK)))
    assert SmoothRate(fastest_s_curves(bounds, WAY), ACC, 0.002).bounds_jerk
    assert not SmoothRate(fastest_trapezoids(bounds, WAY), ACC, 0.002).bounds_jerk


@pytest.mark.req("MOT-03")
@pytest.mark.parametrize("share", [0.9, 0.5])
def test_rows_of_a_slowed_s_curve_keep_the_jerk_by_differences(share: float) -> None:
    """On arm7, beside all bounds of its joints: rows on the clock of joints alone had 10 times as much."""
    name, dt = "arm7", 0.005
    robot = machine(name)
    path, limits = robot.line(WAYS[name], (0.1, -0.2, 0.15)), slow_limits(name, share)
    speed, acc = SPEEDS[name]
    bounds = (path.length, speed, acc, acc / 0.1)
    law = fastest_s_curves(Sections(*(np.array([value]) for value in bounds)), path.length)
    found = plan_motion(robot.model(limits), robot.task(path, law, dt))
    assert isinstance(found, PlannedMotion)
    s = np.concatenate([np.zeros(3), found.demands.s, np.full(2, path.length)])
    assert np.max(np.abs(np.diff(s, 3))) / dt**3 <= bounds[-1] * (1.0 + 1e-6)
    rows = np.vstack([robot.start, found.q])
    assert excess(rows, dt, *(limits.pair(kind) for kind in ("position", "speed", "acceleration"))).none
    assert len(found.q) * dt > law.duration + dt
