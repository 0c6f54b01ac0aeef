"""The trapezoidal time law against its closed form and numeric integration, and whole ticks."""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest
from scipy.integrate import quad

from irlx.diagnostics import Place
from irlx.motion.errors import MotionError
from irlx.motion.trapezoid import Trapezoid
from irlx.motion.whole_ticks import MOST_TICKS, ticks_of_move, whole_ticks

pytestmark = pytest.mark.req("MOT-03")

CASES = {
    "trapezoid": (2.0, 1.0, 2.0),
    "triangle": (0.3, 1.0, 2.0),
    "exactly on the border": (0.5, 1.0, 2.0),
    "tiny": (1e-9, 1.0, 2.0),
    "huge": (1e4, 0.5, 0.01),
    "slow": (1.0, 1e-6, 1.0),
    "hard": (1.0, 1.0, 1e9),
}


def shortest_time(length: float, speed: float, acc: float) -> float:
    return 2.0 * sqrt(length / acc) if speed**2 >= length * acc else length / speed + speed / acc


@pytest.fixture(params=CASES.values(), ids=CASES.keys())
def case(request: pytest.FixtureRequest) -> tuple[float, float, float]:
    return request.param


@pytest.fixture(params=[1.0, 1.7], ids=["fastest", "stretched"])
def law(case, request: pytest.FixtureRequest) -> Trapezoid:
    fastest = Trapezoid.fastest(*case)
    return fastest if request.param == 1.0 else fastest.stretched(request.param * fastest.duration)


def test_fastest_takes_the_shortest_time_within_the_bounds(case) -> None:
    assert Trapezoid.fastest(*case).duration == pytest.approx(shortest_time(*case), rel=1e-14)


def test_rate_integrates_to_the_way(law: Trapezoid) -> None:
    times = np.linspace(0.0, law.duration, 41)
    s, _ = law.evaluate(times)
    knots = [law.ramp, law.ramp + law.cruise]
    for t, way in zip(times, s, strict=True):
        inside = [knot for knot in knots if 0.0 < knot < t]
        area, _ = quad(lambda u: float(law.evaluate(np.array([u]))[1][0]), 0.0, t, points=inside or None)
        assert way == pytest.approx(area, abs=1e-10 * law.length), f"t = {t!r}"


def test_speed_and_acceleration_by_differences_stay_within_the_bounds(case, law: Trapezoid) -> None:
    length, speed, acc = case
    times = np.linspace(0.0, law.duration, 2001)
    s, rate = law.evaluate(times)
    h = times[1]
    assert rate.max() <= speed * (1 + 1e-12)
    assert np.diff(s).min() >= -1e-15 * length
    assert np.max(np.diff(s)) / h <= speed * (1 + 1e-9)
    assert np.max(np.abs(np.diff(rate))) / h <= acc * (1 + 1e-9)


def test_starts_and_ends_at_rest_exactly_on_the_way(case, law: Trapezoid) -> None:
    s, rate = law.evaluate(np.array([-1.0, 0.0, law.duration, law.duration + 1.0]))
    assert s.tolist() == [0.0, 0.0, case[0], case[0]]
    assert rate.tolist() == [0.0] * 4


def test_symmetric_in_time(law: Trapezoid) -> None:
    times = np.linspace(0.0, law.duration, 101)
    s, rate = law.evaluate(times)
    np.testing.assert_allclose(s + s[::-1], law.length, rtol=1e-12)
    np.testing.assert_allclose(rate, rate[::-1], atol=1e-10 * law.speed)


def test_stretching_scales_time_alone(case) -> None:
    fastest = Trapezoid.fastest(*case)
    slow = fastest.stretched(3.0 * fastest.duration)
    times = np.linspace(0.0, fastest.duration, 57)
    np.testing.assert_allclose(slow.evaluate(3.0 * times)[0], fastest.evaluate(times)[0], rtol=1e-11)
    assert slow.duration == pytest.approx(3.0 * fastest.duration, rel=1e-14)
    assert slow.speed == pytest.approx(fastest.speed / 3.0, rel=1e-14)
    assert slow.acc == pytest.approx(fastest.acc / 9.0, rel=1e-12)


@pytest.mark.req("MOT-04")
@pytest.mark.parametrize(
    ("duration", "dt", "ticks"),
    [
        (0.1, 0.01, 10),
        (0.1 * (1 + 1e-15), 0.01, 10),
        (0.1 + 0.9e-8, 0.01, 10),
        (0.1 + 1.1e-8, 0.01, 11),
        (0.1 - 1e-8, 0.01, 10),
        (0.101, 0.01, 11),
        (1e-12, 0.01, 1),
        (0.3, 0.1, 3),
        (12.5, 0.00025, 50000),
    ],
)
def test_duration_is_rounded_up_to_whole_ticks(duration: float, dt: float, ticks: int) -> None:
    assert whole_ticks(duration, dt) == ticks


@pytest.mark.req("MOT-04")
@pytest.mark.parametrize("duration", [float("inf"), float("nan"), 1e300, 0.001 * (MOST_TICKS + 1)])
def test_moves_of_too_many_ticks_are_refused(duration: float) -> None:
    place = Place("long.irl")
    with pytest.raises(MotionError) as caught:
        ticks_of_move(duration, 0.001, place)
    assert caught.value.reason.code == "IRL425"
    assert caught.value.reason.place == place
    assert ticks_of_move(0.001 * MOST_TICKS, 0.001, place) == MOST_TICKS
