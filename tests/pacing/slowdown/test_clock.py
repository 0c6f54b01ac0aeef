"""The fastest clock against closed forms, a linear program, and dense sampling in time."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
import pytest
from scipy.optimize import linprog

from irlx.motion.trapezoid import Trapezoid
from irlx.pacing.slowdown.clock import plan_clock, stopping_clock
from irlx.pacing.slowdown.clock_bounds import PATH, ClockBounds, Governor, clock_bounds
from irlx.pacing.slowdown.curve import JointCurve
from long_run import first

pytestmark = pytest.mark.req("MOT-21")

FAST, HARD = 100.0, 1e6
"""A programme that leaves the joints to govern."""


def planned(curve: JointCurve, lim, rate=FAST, acc=HARD):
    rates = np.full(curve.s.size, float(rate)) if np.isscalar(rate) else rate(curve.s)
    bounds = clock_bounds(curve, lim, rates, acc)
    clock = plan_clock(bounds)
    assert clock is not None
    return bounds, clock


def shortest(way: float, speed: float, acc: float) -> float:
    return 2.0 * np.sqrt(way / acc) if speed**2 >= way * acc else way / speed + speed / acc


def straight(way: np.ndarray, intervals: int = 400) -> JointCurve:
    """A joint-space line over s in [0, 1], knots crowded at its ends."""
    s = 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, intervals + 1)))
    return JointCurve(s, s[:, None] * way)


# ---- closed forms


@pytest.mark.parametrize(("speed", "acc"), [(1.0, 2.0), (5.0, 2.0), (0.1, 3.0), (1.0, 1e3)])
def test_straight_joint_line_is_a_trapezoid_or_a_triangle(tools, speed: float, acc: float) -> None:
    way = np.array([0.4, -1.2, 0.9])
    _, clock = planned(straight(way), tools.limits(3, speed, acc))
    wanted = shortest(1.2, speed, acc)
    assert 1.0 - 1e-9 <= clock.duration / wanted <= 1.003


def test_each_joint_has_its_own_bounds(tools) -> None:
    """The slowest joint governs the cruise, another one the ramps."""
    way, speed, acc = np.array([1.0, 1.0]), np.array([0.5, 3.0]), np.array([9.0, 1.0])
    _, clock = planned(straight(way), tools.limits(2, speed, acc))
    assert clock.duration == pytest.approx(shortest(1.0, 0.5, 1.0), rel=2e-3)


def test_a_joint_that_rests_but_for_rounding_bounds_no_speed(tools) -> None:
    """It may not move at all, and the other one goes as fast as without it."""
    curve = straight(np.array([1.0, 1e-15]))
    bounds = clock_bounds(curve, tools.limits(2, np.array([0.5, 0.0]), 9.0), np.full(401, FAST), HARD)
    assert np.max(bounds.cap) == pytest.approx(0.25, rel=1e-3)
    assert set(bounds.joint[bounds.governor == Governor.SPEED]) == {0}


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_asymmetric_limits_count_by_direction(tools, way: float) -> None:
    """Speeding up by 4, braking by 1 towards +; the other way round towards -."""
    lim = tools.limits(1, 0.8, 4.0, slowest=-0.5, hardest=-1.0)
    _, clock = planned(straight(np.array([way])), lim)
    speed, up, down = (0.8, 4.0, 1.0) if way > 0 else (0.5, 1.0, 4.0)
    ramps = 0.5 * speed * (1.0 / up + 1.0 / down)
    wanted = (1.0 - speed * ramps) / speed + speed / up + speed / down
    assert clock.duration == pytest.approx(wanted, rel=2e-3)


def test_monotone_sinusoid_takes_the_time_of_its_way(tools) -> None:
    """One joint that never turns back: however it is written over s, it is a rest-to-rest move."""
    wave = tools.wave(np.array([[1.0]]), np.array([[-1.2]]), 2.4)
    _, clock = planned(wave.curve(400), tools.limits(1, 0.7, 2.0))
    assert clock.duration == pytest.approx(shortest(2.0 * np.sin(1.2), 0.7, 2.0), rel=1e-2)
    assert clock.duration >= shortest(2.0 * np.sin(1.2), 0.7, 2.0) * (1.0 - 1e-3)


def test_sinusoid_that_turns_back_stops_and_returns(tools) -> None:
    """Up to the crest and back: at the crest the joint rests but need not hesitate."""
    wave = tools.wave(np.array([[1.0]]), np.array([[np.pi / 2 - 1.0]]), 2.0)
    _, clock = planned(wave.curve(400), tools.limits(1, 10.0, 2.0))
    wanted = 2.0 * shortest(1.0 - np.cos(1.0), 10.0, 2.0)
    assert wanted * (1.0 - 1e-3) <= clock.duration <= wanted * 1.01


def test_programme_alone_is_kept_exactly(tools) -> None:
    law = Trapezoid.fastest(1.0, 0.5, 1.0)
    s = np.concatenate(
        [np.linspace(0, 0.125, 50), np.linspace(0.125, 0.875, 90)[1:], np.linspace(0.875, 1, 50)[1:]]
    )
    curve = JointCurve(s, np.sin(s[:, None] * [1.0, 2.0]))
    _, clock = planned(curve, tools.limits(2), law.rates_at, law.acc)
    assert clock.duration == pytest.approx(law.duration, rel=1e-9)
    np.testing.assert_allclose(clock.x, law.rates_at(s) ** 2, atol=1e-12)
    times = np.linspace(0.0, law.duration, 300)
    np.testing.assert_allclose(clock.at(times)[0], law.evaluate(times)[0], atol=1e-9)


# ---- a second solver


def drawn_case(tools, seed: int):
    """A smooth curve, limits around what a uniform motion uses, one side narrower, some unlimited."""
    rng = np.random.default_rng(seed)
    joints = int(rng.integers(1, 8))
    wave = tools.random_wave(rng, joints)
    s = np.linspace(0.0, wave.length, 400)
    v = np.max(np.abs(wave.of(s, 1)), axis=0) * rng.uniform(0.3, 1.5, joints)
    a = np.max(np.abs(wave.of(s, 2)) + np.abs(wave.of(s, 1)), axis=0) * rng.uniform(0.4, 3.0, joints)
    v, a = (np.where(rng.random(joints) < 0.2, np.inf, side) for side in (v, a))
    share = rng.uniform(0.5, 1.0, (2, joints))
    return wave, tools.limits(joints, v, a, slowest=-share[0] * v, hardest=-share[1] * a)


def with_corners(wave, law: Trapezoid) -> np.ndarray:
    corners = law.corners
    pieces = [np.linspace(a, b, 201)[1:] for a, b in itertools.pairwise(corners)]
    return np.concatenate([[0.0], *pieces])


@pytest.mark.parametrize("seed", first(6, range(12)))
def test_as_fast_as_a_linear_program_finds_and_never_faster(tools, seed: int) -> None:
    wave, lim = drawn_case(tools, seed)
    law = Trapezoid.fastest(wave.length, 1.2, 3.0)
    s = with_corners(wave, law)
    _, clock = planned(JointCurve(s, wave.of(s)), lim, law.rates_at, law.acc)
    least = tools.second_solver(wave, lim, law.rates_at, law.acc)
    assert 1.0 - 1e-3 <= clock.duration / least <= 1.01, f"seed {seed}"


# ---- every bound, sampled in time


@pytest.mark.req("MOT-20")
@pytest.mark.parametrize("seed", range(20, 40))
def test_every_bound_holds_between_the_knots(tools, seed: int) -> None:
    wave, lim = drawn_case(tools, seed)
    law = Trapezoid.fastest(wave.length, 1.2, 3.0)
    curve = wave.curve(250)
    _, clock = planned(curve, lim, law.rates_at, law.acc)
    times = np.linspace(0.0, clock.duration, 20001)
    s, rate = clock.at(times)
    assert (s[0], rate[0]) == (0.0, 0.0)
    assert rate[-1] <= 1e-12
    assert s[-1] == pytest.approx(wave.length, abs=1e-12)
    assert np.all(np.diff(s) >= 0.0)
    assert np.all(clock.x <= law.rates_at(clock.s) ** 2)
    assert np.max(np.abs(np.diff(rate)) / times[1]) <= law.acc * (1.0 + 1e-9)
    q = curve.at(s)
    v = np.diff(q, axis=0) / times[1]
    a = np.diff(v, axis=0) / times[1]
    noise = 8.0 * np.spacing(np.abs(q).max())
    assert np.all(v <= lim.speed_upper + noise / times[1])
    assert np.all(v >= lim.speed_lower - noise / times[1])
    assert np.all(a <= lim.acceleration_upper + noise / times[1] ** 2)
    assert np.all(a >= lim.acceleration_lower - noise / times[1] ** 2)


def test_reserves_are_kept_at_the_knots(tools) -> None:
    """A line at constant slope: speeds stay 1E-5, accelerations 1E-3 below their bounds, and no more."""
    _, clock = planned(straight(np.array([1.0])), tools.limits(1, 0.5, 2.0))
    assert np.sqrt(clock.x.max()) == pytest.approx(0.5 * (1.0 - 1e-5), rel=1e-12)
    u = 0.5 * np.diff(clock.x) / np.diff(clock.s)
    assert np.max(np.abs(u)) == pytest.approx(2.0 * (1.0 - 1e-3), rel=1e-9)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_zero_speed_on_the_side_that_nobody_goes_costs_nothing(tools, side: float) -> None:
    lim = tools.limits(1, 0.5, 2.0)
    zero = np.zeros(1)
    one = lim.with_pair("speed", *((zero, lim.speed_upper) if side > 0 else (lim.speed_lower, zero)))
    curve = straight(np.array([side]))
    assert planned(curve, one)[1].duration == planned(curve, lim)[1].duration


@pytest.mark.parametrize("kind", ["speed", "acceleration"])
def test_zero_on_the_side_that_is_needed_stands_still(tools, kind: str) -> None:
    lim = tools.limits(1, 0.5, 2.0).with_pair(kind, np.array([-1.0]), np.zeros(1))
    bounds = clock_bounds(straight(np.array([1.0])), lim, np.full(401, 1.0), 1.0)
    clock = plan_clock(bounds)
    assert clock is not None
    assert np.any(clock.x[1:-1] == 0.0)
    assert clock.duration == np.inf


def test_joint_that_rests_has_no_say_however_narrow_its_limits(tools) -> None:
    lim = tools.limits(2, [0.0, 0.5], [0.0, 2.0])
    way = np.array([0.0, 1.0])
    alone = planned(straight(way[1:]), tools.limits(1, 0.5, 2.0))[1]
    assert planned(straight(way), lim)[1].duration == alone.duration


# ---- who governs


def test_the_joint_at_its_speed_is_named_where_it_is(tools) -> None:
    """Joint 1 is fast in the middle alone, joint 0 never; the programme rules the rest."""
    s = np.linspace(0.0, 1.0, 401)
    q = np.column_stack([0.1 * s, np.tanh(20.0 * (s - 0.5))])
    law = Trapezoid.fastest(1.0, 0.5, 5.0)
    _, clock = planned(JointCurve(s, q), tools.limits(2, 1.0), law.rates_at, law.acc)
    middle = int(np.argmin(np.abs(s - 0.5)))
    assert (clock.governor[middle], clock.joint[middle]) == (Governor.SPEED, 1)
    quarter = int(np.argmin(np.abs(s - 0.2)))
    assert (clock.governor[quarter], clock.joint[quarter]) == (Governor.PROGRAM, PATH)


def test_the_joint_at_its_acceleration_is_named(tools) -> None:
    """In a narrow bend at constant rate only the acceleration of joint 2 is more than allowed."""
    s = np.linspace(0.0, 1.0, 801)
    q = np.column_stack([s, 0.2 * s, 0.05 * np.sqrt(0.05**2 + (s - 0.5) ** 2) * 4.0])
    lim = tools.limits(3, np.inf, [50.0, 50.0, 0.5])
    law = Trapezoid.fastest(1.0, 0.5, 5.0)
    _, clock = planned(JointCurve(s, q), lim, law.rates_at, law.acc)
    middle = 400
    assert clock.x[middle] < 0.9 * law.speed**2
    assert (clock.governor[middle], clock.joint[middle]) == (Governor.ACCELERATION, 2)


def test_braking_is_blamed_on_the_narrow_place_behind(tools) -> None:
    """Before the steep part of joint 1 the clock brakes under joint 0's acceleration for joint 1's speed."""
    s = np.linspace(0.0, 1.0, 401)
    q = np.column_stack([s, np.clip(s - 0.5, 0.0, None) ** 3 * 8.0])
    clock = planned(JointCurve(s, q), tools.limits(2, 0.6, [0.5, 100.0]), 0.55, 100.0)[1]
    slowed = np.flatnonzero((clock.governor == Governor.SPEED) & (s < 0.9) & (clock.joint == 1))
    assert slowed.size > 10
    assert np.all(np.diff(slowed) == 1)


# ---- entering and stopping


@dataclass(frozen=True)
class Whole:
    bounds: ClockBounds
    x: np.ndarray


@pytest.fixture(params=[3, 11, 27])
def whole(request: pytest.FixtureRequest, tools) -> Whole:
    wave, lim = drawn_case(tools, request.param)
    law = Trapezoid.fastest(wave.length, 1.2, 3.0)
    bounds, clock = planned(wave.curve(120), lim, law.rates_at, law.acc)
    return Whole(bounds, clock.x)


def last(bounds: ClockBounds) -> int:
    return len(bounds.s) - 1


def test_a_plan_from_any_knot_is_the_rest_of_the_whole_plan(whole: Whole) -> None:
    for knot in range(1, last(whole.bounds)):
        rest = plan_clock(
            whole.bounds.part(knot, last(whole.bounds)), start_rate=float(np.sqrt(whole.x[knot]))
        )
        assert rest is not None, knot
        np.testing.assert_allclose(rest.x, whole.x[knot:], rtol=1e-9, atol=1e-12)
        assert rest.s[0] == whole.bounds.s[knot]


def feasible(bounds: ClockBounds, first: int, end: int, rate: float) -> bool:
    """Whether some clock enters knot `first` at a rate and rests at knot `end`, by a linear program."""
    count = end - first
    matrix, right = [], []
    for i in range(count):
        h = bounds.s[first + i + 1] - bounds.s[first + i]
        for top, bottom, slope in zip(
            *(getattr(bounds, k)[first + i] for k in ("top", "bottom", "slope")), strict=True
        ):
            for sign, bound in ((1.0, top), (-1.0, -bottom)):
                row = np.zeros(count + 1)
                row[i], row[i + 1] = -sign * (1.0 + 2 * h * slope), sign
                if np.isfinite(bound):
                    matrix.append(row)
                    right.append(2 * h * bound)
    ends = [(rate**2, rate**2), *[(0.0, cap) for cap in bounds.cap[first + 1 : end]], (0.0, 0.0)]
    if rate**2 > bounds.cap[first]:
        return False
    return linprog(np.zeros(count + 1), np.array(matrix), np.array(right), bounds=ends).status == 0


@pytest.mark.parametrize("share", [1.0, 0.5])
@pytest.mark.parametrize("place", [0.3, 0.6])
def test_a_stop_is_the_first_one_that_is_possible(whole: Whole, place: float, share: float) -> None:
    knot = int(place * last(whole.bounds))
    rate = share * float(np.sqrt(whole.x[knot])) * (1.0 - 1e-9)
    stop = stopping_clock(whole.bounds, knot, rate)
    assert stop is not None
    end = knot + len(stop.s) - 1
    assert (stop.s[0], stop.s[-1], stop.x[-1]) == (whole.bounds.s[knot], whole.bounds.s[end], 0.0)
    assert np.sqrt(stop.x[0]) == pytest.approx(rate, rel=1e-12)
    assert feasible(whole.bounds, knot, end, rate * (1.0 - 1e-7))
    assert end == knot + 1 or not feasible(whole.bounds, knot, end - 1, rate)


def test_stops_keep_every_line(whole: Whole) -> None:
    knot = last(whole.bounds) // 2
    stop = stopping_clock(whole.bounds, knot, float(np.sqrt(whole.x[knot])))
    assert stop is not None
    part = whole.bounds.part(knot, knot + len(stop.s) - 1)
    u = 0.5 * np.diff(stop.x) / np.diff(stop.s)
    x, slack = stop.x[:-1, None], 1e-9 * (1.0 + np.abs(u).max())
    assert np.all(u[:, None] <= part.top + part.slope * x + slack)
    assert np.all(u[:, None] >= part.bottom + part.slope * x - slack)


def test_too_fast_an_entry_has_no_clock(whole: Whole) -> None:
    knot = last(whole.bounds) // 2
    part = whole.bounds.part(knot, last(whole.bounds))
    too_fast = 1.05 * float(np.sqrt(whole.bounds.cap[knot]))
    assert plan_clock(part, start_rate=too_fast) is None
    assert stopping_clock(whole.bounds, knot, too_fast) is None


def test_an_entry_just_too_fast_to_brake_has_no_clock(tools) -> None:
    """Half a metre before the end, braking by 2: sqrt(2 2 0.5) is the fastest."""
    s = np.linspace(0.0, 1.0, 201)
    bounds = clock_bounds(JointCurve(s, s[:, None]), tools.limits(1, np.inf, 2.0), np.full(201, 9.0), HARD)
    fastest = np.sqrt(2.0 * 2.0 * (1.0 - 1e-3) * 0.5)
    part = bounds.part(100, 200)
    assert plan_clock(part, start_rate=fastest * (1.0 + 1e-6)) is None
    assert plan_clock(part, start_rate=fastest * (1.0 - 1e-6)) is not None


def test_an_end_rate_is_kept(tools) -> None:
    bounds = clock_bounds(straight(np.array([1.0])), tools.limits(1, 0.5, 2.0), np.full(401, 9.0), HARD)
    clock = plan_clock(bounds, end_rate=0.3)
    assert clock is not None
    assert np.sqrt(clock.x[-1]) == pytest.approx(0.3, rel=1e-12)
    assert clock.x[0] == 0.0
