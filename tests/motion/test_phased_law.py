"""Laws of phases: against integration, a linear programme, and an independent generator of S curves."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

import numpy as np
import pytest
from ruckig import InputParameter, Ruckig, Trajectory
from scipy.optimize import linprog
from scipy.sparse import diags

from irlx.motion.fastest_law import fastest_s_curves, fastest_trapezoids
from irlx.motion.phased_law import PhasedLaw
from irlx.motion.s_curve import reach, rising
from irlx.motion.sections import Sections
from irlx.motion.trapezoid import Trapezoid

pytestmark = pytest.mark.req("MOT-03")

LAWS = {"trapezoids": fastest_trapezoids, "s curves": fastest_s_curves}


def sections(rng: np.random.Generator, count: int) -> Sections:
    """Sections of mixed sizes, some next to nothing, some with the bounds of the one before."""
    lengths = 10.0 ** rng.uniform(-4.0, 0.0, count)
    lengths[rng.random(count) < 0.1] = 1e-9
    found = [lengths, *(10.0 ** rng.uniform(low, low + 1.0, count) for low in (-1.0, 0.0, 1.0))]
    for k in np.flatnonzero(rng.random(count) < 0.3):
        for column in found[1:]:
            column[k] = column[k - 1]
    return Sections(*found)


def planned(kind: str, seed: int, count: int) -> tuple[PhasedLaw, Sections]:
    bounds = sections(np.random.default_rng(seed), count)
    return LAWS[kind](bounds, float(np.sum(bounds.lengths))), bounds


@pytest.mark.parametrize("fastest", [fastest_trapezoids, fastest_s_curves])
def test_a_section_without_length_bounds_the_rate_in_its_place(fastest) -> None:
    """First, last, or between two others; a short one counts as one of no length."""
    for number, varying in product(range(3), (True, False)):
        times = []
        for length in (0.0, 1e-12):
            lengths, speed = np.full(3, 0.2), np.full(3, 0.5)
            lengths[number], speed[number] = length, 0.1
            bounds = Sections(lengths, speed, np.full(3, 2.0), np.full(3, 40.0), np.full(3, varying))
            law = fastest(bounds, float(np.sum(lengths)))
            times.append(law.duration)
            assert law.rates_at(np.array([0.2]))[0] == pytest.approx(0.1 if number == 1 else 0.5)
        assert times[0] == pytest.approx(times[1], rel=1e-4)


@pytest.mark.parametrize("count", [1, 2, 9, 60])
@pytest.mark.parametrize("kind", LAWS)
def test_the_way_is_the_integral_of_the_rate(kind: str, count: int) -> None:
    law, _ = planned(kind, count, count)
    s, rate = law.evaluate(np.linspace(0.0, law.duration, 400_001))
    h = law.duration / 400_000
    way = np.concatenate([[0.0], np.cumsum(0.5 * h * (rate[1:] + rate[:-1]))])
    assert np.max(np.abs(way - s)) < 1e-6 * law.length
    assert np.min(np.diff(s)) >= 0.0
    assert s[0] == 0.0
    assert s[-1] == law.length
    assert rate[0] == rate[-1] == 0.0


@pytest.mark.parametrize("count", [1, 3, 40])
@pytest.mark.parametrize("kind", LAWS)
def test_bounds_hold_in_every_section(kind: str, count: int) -> None:
    law, bounds = planned(kind, 7 + count, count)
    ends = np.concatenate([[0.0], np.cumsum(bounds.lengths)])
    t = np.linspace(0.0, law.duration, 200_001)
    s, rate = law.evaluate(t)
    k = np.clip(np.searchsorted(ends, s, side="right") - 1, 0, count - 1)
    # Right at the end of a section the rate may be that of the next one.
    away = np.abs(s - ends[k]) > 1e-6
    away &= np.abs(s - ends[k + 1]) > 1e-6
    assert np.all(rate[away] <= bounds.speed[k[away]] * (1.0 + 1e-9))
    phase = np.searchsorted(law.ways, s[away], side="right") - 1
    ends_acc = law.starts + law.jerks * np.diff(law.times)
    for acc in (law.starts[phase], ends_acc[phase]):
        assert np.all(np.abs(acc) <= bounds.acc[k[away]] * (1.0 + 1e-9))
    assert np.all(law.acc_at(s[away]) <= bounds.acc[k[away]])
    if kind == "s curves":
        assert np.all(np.abs(law.jerks[phase]) <= bounds.jerk[k[away]] * (1.0 + 1e-9))


@pytest.mark.parametrize("count", [1, 2, 40])
@pytest.mark.parametrize("kind", LAWS)
def test_inverse_is_exact(kind: str, count: int) -> None:
    law, _ = planned(kind, 100 + count, count)
    s = np.concatenate([np.linspace(0.0, law.length, 3001), law.ways, [1e-18, law.length - 1e-15]])
    there, rate = law.evaluate(law.times_at(s))
    assert np.max(np.abs(there - s)) <= 1e-14 * law.length
    assert np.max(np.abs(rate - law.rates_at(s))) <= 1e-6 * law.speed
    inner = (s > 1e-6 * law.length) & (s < (1.0 - 1e-6) * law.length)
    assert np.max(np.abs(rate - law.rates_at(s))[inner]) <= 1e-10 * law.speed
    assert law.times_at(np.array([0.0, law.length])).tolist() == [0.0, law.duration]
    assert law.rates_at(np.array([0.0, law.length])).tolist() == [0.0, 0.0]


@pytest.mark.parametrize("kind", LAWS)
def test_stretched(kind: str) -> None:
    law, _ = planned(kind, 5, 12)
    slow = law.stretched(2.5 * law.duration)
    t = np.linspace(0.0, law.duration, 501)
    (s, rate), (slow_s, slow_rate) = law.evaluate(t), slow.evaluate(2.5 * t)
    assert slow.duration == 2.5 * law.duration
    assert np.max(np.abs(s - slow_s)) < 1e-13
    assert np.max(np.abs(rate - 2.5 * slow_rate)) < 1e-12
    assert slow.acc == pytest.approx(law.acc / 2.5**2, rel=1e-12)
    assert np.allclose(slow.acc_at(s), law.acc_at(s) / 2.5**2, rtol=1e-12)


def test_one_section_is_a_trapezoid() -> None:
    for speed in (0.3, 5.0):
        bounds = Sections(*(np.array([value]) for value in (0.7, speed, 2.0, 1.0)))
        law, other = fastest_trapezoids(bounds, 0.7), Trapezoid.fastest(0.7, speed, 2.0)
        t = np.linspace(-0.1, other.duration + 0.1, 301)
        assert law.duration == pytest.approx(other.duration, rel=1e-15)
        for mine, theirs in zip(law.evaluate(t), other.evaluate(t), strict=True):
            assert np.allclose(mine, theirs, rtol=0.0, atol=1e-14)
        assert law.corners == pytest.approx(other.corners)
        assert (law.speed, law.acc) == pytest.approx((other.speed, other.acc))


@pytest.mark.parametrize("seed", range(4))
def test_no_law_of_a_linear_programme_is_faster(seed: int) -> None:
    """The squares of the rates on a grid, as large as can be: exact for accelerations constant between."""
    rng = np.random.default_rng(seed)
    count, each = 8, 60
    speed, acc = rng.uniform(0.1, 1.0, count), rng.uniform(0.3, 3.0, count)
    h = 0.002
    bounds = Sections(np.full(count, each * h), speed, acc, np.ones(count))
    law = fastest_trapezoids(bounds, count * each * h)
    knots = count * each + 1
    square = np.minimum(np.append(np.repeat(speed, each), 9.0), np.append(9.0, np.repeat(speed, each))) ** 2
    square[[0, -1]] = 0.0
    steps = diags([-np.ones(knots - 1), np.ones(knots - 1)], [0, 1], shape=(knots - 1, knots))
    room = 2.0 * h * np.repeat(acc, each)
    solved = linprog(
        -np.ones(knots),
        A_ub=np.vstack([steps.toarray(), -steps.toarray()]),
        b_ub=np.concatenate([room, room]),
        bounds=np.column_stack([np.zeros(knots), square]),
    )
    rate = np.sqrt(np.maximum(solved.x, 0.0))
    duration = float(np.sum(2.0 * h / (rate[:-1] + rate[1:])))
    assert law.duration == pytest.approx(duration, rel=1e-3)
    assert law.duration <= duration * (1.0 + 1e-9)


def ruckig_time(way: float, first: float, last: float, speed: float, acc: float, jerk: float) -> float:
    wanted = InputParameter(1)
    wanted.current_position, wanted.target_position = [0.0], [way]
    wanted.current_velocity, wanted.target_velocity = [first], [last]
    wanted.max_velocity, wanted.max_acceleration, wanted.max_jerk = [speed], [acc], [jerk]
    trajectory = Trajectory(1)
    Ruckig(1).calculate(wanted, trajectory)
    return float(trajectory.duration)


def test_an_s_curve_is_as_fast_as_that_of_ruckig() -> None:
    rng = np.random.default_rng(11)
    for _ in range(300):
        way, speed = 10.0 ** rng.uniform(-6.0, 2.0), 10.0 ** rng.uniform(-3.0, 1.0)
        acc = 10.0 ** rng.uniform(-2.0, 2.0)
        jerk = acc * 10.0 ** rng.uniform(0.0, 3.0)
        law = fastest_s_curves(Sections(*(np.array([v]) for v in (way, speed, acc, jerk))), way)
        assert law.duration == pytest.approx(ruckig_time(way, 0.0, 0.0, speed, acc, jerk), rel=1e-9)
        assert len(law.jerks) <= 7


def test_s_curves_between_sections_are_as_fast_as_those_of_ruckig() -> None:
    """Where the rate at the end can only just be reached ruckig may run back; away from that both agree."""
    law, bounds = planned("s curves", 42, 30)
    ends = np.concatenate([[0.0], np.cumsum(bounds.lengths)])
    rates, times = law.rates_at(ends), law.times_at(ends)
    compared = 0
    for k, row in enumerate(
        zip(bounds.lengths, rates[:-1], rates[1:], bounds.speed, bounds.acc, bounds.jerk, strict=True)
    ):
        slow, fast = sorted(row[1:3])
        if reach(slow, row[0], row[4], row[5]) < fast * (1.0 + 1e-6):
            continue
        compared += 1
        assert times[k + 1] - times[k] == pytest.approx(ruckig_time(*row), rel=1e-6, abs=1e-9)
    assert compared > 8


def test_reach_is_the_inverse_of_rising() -> None:
    rng = np.random.default_rng(3)
    for _ in range(500):
        first = rng.choice([0.0, 10.0 ** rng.uniform(-4.0, 1.0)])
        acc = 10.0 ** rng.uniform(-2.0, 2.0)
        jerk = acc * 10.0 ** rng.uniform(-1.0, 3.0)
        way = 10.0 ** rng.uniform(-9.0, 4.0)
        last = reach(first, way, acc, jerk)
        assert last > first or way < 1e-6
        if last - first > 1e-6 * last:
            assert rising(first, last, acc, jerk)[1] == pytest.approx(way, rel=1e-9)


@pytest.mark.parametrize("scale", [1e-9, 1e4])
@pytest.mark.parametrize("fastest", LAWS.values(), ids=LAWS)
def test_sizes(fastest: Callable[[Sections, float], PhasedLaw], scale: float) -> None:
    bounds = Sections(np.array([0.3, 0.7]) * scale, np.array([0.5, 0.2]), np.ones(2), np.full(2, 20.0))
    law = fastest(bounds, scale)
    s, _ = law.evaluate(np.linspace(0.0, law.duration, 1001))
    assert np.all(np.diff(s) >= 0.0)
    assert s[-1] == scale


@pytest.mark.parametrize("kind", LAWS)
def test_before_and_behind_the_way_all_is_as_at_its_ends(kind: str) -> None:
    law, _ = planned(kind, 3, 2)
    outside = np.array([-0.5 * law.length, 1.5 * law.length])
    assert law.times_at(outside).tolist() == [0.0, law.duration]
    assert law.rates_at(outside).tolist() == [0.0, 0.0]


@pytest.mark.parametrize("acc", [0.8, 8.0])
@pytest.mark.parametrize("count", [1, 2, 36])
def test_ramps_at_the_ends_of_a_curve_are_as_fast_as_those_of_a_line(count: int, acc: float) -> None:
    """A section is no ramp: 60 mm/s took all of the first and last one, whatever ACC, in 28 ticks for 15."""
    lengths, columns = np.full(count, 0.15 / count), np.ones((3, count))
    bounds = Sections(lengths, 0.06 * columns[0], acc * columns[1], columns[2], np.ones(count, dtype=bool))
    law, line = fastest_trapezoids(bounds, 0.15), Trapezoid.fastest(0.15, 0.06, acc)
    assert law.duration == pytest.approx(line.duration, rel=1e-9)
    t = np.linspace(0.0, line.duration, 1001)
    np.testing.assert_allclose(law.evaluate(t)[1], line.evaluate(t)[1], atol=1e-9)


@pytest.mark.parametrize("top", [0.13, 0.2, 0.29, 9.0])
def test_a_ramp_ends_within_a_section_of_a_curve_and_not_at_its_border(top: float) -> None:
    """Wherever in it; a way too short for the speed is a triangle, its top within a section too."""
    lengths = np.full(35, 0.01)
    bounds = Sections(lengths, np.full(35, top), np.ones(35), np.ones(35), np.ones(35, dtype=bool))
    law, line = fastest_trapezoids(bounds, 0.35), Trapezoid.fastest(0.35, top, 1.0)
    assert law.duration == pytest.approx(line.duration, rel=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_on_a_curve_bounds_hold_and_the_rate_falls_no_later_than_evenly(seed: int) -> None:
    """By differences in time; to a narrower section the square of the rate changes evenly."""
    rng = np.random.default_rng(seed)
    count = 40
    s = np.arange(count) / count
    speed = 0.3 + 0.2 * np.sin(9.0 * s + rng.uniform(0.0, 6.0)) + 0.05 * rng.random()
    acc = np.full(count, 10.0 ** rng.uniform(-0.5, 0.5))
    bounds = Sections(np.full(count, 1.0 / count), speed, acc, np.ones(count), np.ones(count, dtype=bool))
    law = fastest_trapezoids(bounds, 1.0)
    t = np.linspace(0.0, law.duration, 100_001)
    way, rate = law.evaluate(t)
    section = np.clip((way * count).astype(int), 0, count - 1)
    clear = np.abs(way * count - np.round(way * count)) > 1e-3
    assert np.all(rate[clear] <= speed[section][clear] * (1.0 + 1e-9))
    assert np.max(np.abs(np.diff(rate))) / (t[1] - t[0]) <= acc[0] * (1.0 + 1e-6)
    ends = law.rates_at(np.arange(count + 1.0) / count) ** 2
    half = law.rates_at((np.arange(count) + 0.5) / count) ** 2
    inner = half[1:-1] - 0.5 * (ends[1:-2] + ends[2:-1])
    # Along the slopes of the wave, away from rest and from where a ramp ends, nothing waits for a border.
    assert np.count_nonzero(np.abs(inner) < 1e-9) >= count - 12
