"""Knots of a path: corners, programmed times, and how many there are."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from irlx.motion.fastest_law import fastest_trapezoids
from irlx.motion.line import Line
from irlx.motion.sections import Sections
from irlx.motion.trapezoid import Trapezoid
from irlx.pacing.slowdown.grid import LEAST_INTERVALS, STEP, PathGrid, acc_between, path_grid

pytestmark = pytest.mark.req("MOT-21")

LAWS = {
    "trapezoid": Trapezoid.fastest(0.4, 0.25, 1.5),
    "triangle": Trapezoid.fastest(0.02, 0.25, 1.5),
    "stretched to TIME": Trapezoid.fastest(0.4, 0.25, 1.5).stretched(7.3),
    "stretched triangle": Trapezoid.fastest(0.02, 0.25, 1.5).stretched(3.1),
    "tiny": Trapezoid.fastest(2e-9, 0.25, 1.5),
    "hard ramps": Trapezoid.fastest(0.4, 0.25, 1e3),
    "long": Trapezoid.fastest(50.0, 0.5, 1.5),
}


def grid_of(law: Trapezoid) -> PathGrid:
    end = np.array([law.length, 0.0, 0.0])
    return path_grid(Line(np.zeros(3), np.eye(3), end, np.eye(3)), law)


@pytest.fixture(params=LAWS.values(), ids=LAWS.keys())
def law(request: pytest.FixtureRequest) -> Trapezoid:
    return request.param


def test_times_sum_to_the_duration_of_the_law(law: Trapezoid) -> None:
    assert np.sum(grid_of(law).times) == pytest.approx(law.duration, rel=1e-12)


def test_times_and_rates_are_those_of_the_law(law: Trapezoid) -> None:
    """Evaluated at the times, the law stands at the knots."""
    grid = grid_of(law)
    s, rates = law.evaluate(np.concatenate([[0.0], np.cumsum(grid.times)]))
    np.testing.assert_allclose(s, grid.s, atol=1e-11 * law.length)
    np.testing.assert_allclose(rates[1:-1], grid.rates[1:-1], rtol=1e-5)
    assert np.all(grid.times > 0.0)


def test_corners_of_the_law_are_knots(law: Trapezoid) -> None:
    grid = grid_of(law)
    for corner in law.corners:
        assert np.min(np.abs(grid.s - corner)) <= 1e-15 * law.length
    assert (grid.s[0], grid.s[-1]) == (0.0, law.length)
    assert (grid.rates[0], grid.rates[-1]) == (0.0, 0.0)


def test_intervals_are_even_few_milliseconds_and_enough(law: Trapezoid) -> None:
    grid = grid_of(law)
    assert grid.intervals >= LEAST_INTERVALS
    assert np.diff(grid.s).max() <= law.speed * grid.step * (1.0 + 1e-9)
    pieces = np.searchsorted(grid.s, np.array(law.corners) - 1e-12 * law.length)
    for first, last in itertools.pairwise(pieces):
        widths = np.diff(grid.s[first : last + 1])
        np.testing.assert_allclose(widths, widths[0], rtol=1e-6)


def test_short_motions_have_fine_steps_and_long_ones_coarse_ones() -> None:
    assert grid_of(LAWS["trapezoid"]).step == STEP == 0.004
    assert grid_of(LAWS["long"]).step == 0.016
    assert grid_of(LAWS["long"]).intervals < 7000


def test_poses_are_those_of_the_path(law: Trapezoid) -> None:
    grid = grid_of(law)
    np.testing.assert_allclose(grid.poses.position[:, 0], grid.s, atol=1e-15 * max(1.0, law.length))


@pytest.mark.parametrize("hair", [1e-15, 1e-13, 1e-10, 1e-7])
def test_corners_a_hair_apart_are_one(hair: float) -> None:
    """A cruise of 1E-15 s is rounding; knots so close would make a spline swing."""
    law = Trapezoid.fastest(0.25, 0.5 * (1.0 - hair), 1.0)
    assert 0.0 < law.cruise < 1e-6
    grid = grid_of(law)
    assert np.diff(grid.s).min() > 0.3 * np.diff(grid.s).max()
    assert np.sum(grid.times) == pytest.approx(law.duration, rel=1e-12)


@pytest.mark.req("MOT-03")
@pytest.mark.parametrize("varying", [True, False])
@pytest.mark.parametrize("inner", [[10, 4, 3, 2, 3, 5], [10, 4, 2, 5, 2.1, 5]], ids=["once", "twice"])
def test_the_slowest_place_of_a_narrow_bend_is_a_knot(inner: list[float], varying: bool) -> None:
    """Of corners that are one it stays: elsewhere the clock of slowed joints would run through it faster."""
    lengths = np.array([0.1, 4e-9, 3e-9, 2e-9, 9e-9, 3e-9, 5e-9, 0.2])
    speeds = np.array([0.3, *(1e-4 * np.array(inner)), 0.3])
    flags = varying & (np.arange(8) % 7 > 0)
    bounds = Sections(lengths, speeds, np.full(8, 2.0), np.full(8, np.inf), flags)
    law = fastest_trapezoids(bounds, float(np.sum(lengths)))
    grid = grid_of(law)
    assert np.min(law.rates_at(np.linspace(0.1, 0.1 + 2.6e-8, 2601))) == pytest.approx(2e-4)
    assert np.min(grid.rates[1:-1]) == pytest.approx(2e-4)
    assert np.diff(grid.s).min() > 1e-5 * np.diff(grid.s).max()


# ---- the law's own inverse


def test_rates_and_times_at_a_way_invert_the_law(law: Trapezoid) -> None:
    times = np.linspace(0.0, law.duration, 501)
    s, rates = law.evaluate(times)
    np.testing.assert_allclose(law.times_at(s), times, atol=1e-7 * law.duration)
    inner = slice(1, -1)
    np.testing.assert_allclose(law.rates_at(s)[inner], rates[inner], rtol=1e-7)
    assert law.times_at(np.array([0.0, law.length])).tolist() == pytest.approx([0.0, law.duration], rel=1e-14)


def test_corners_are_where_the_acceleration_changes(law: Trapezoid) -> None:
    inner = law.corners[1:-1]
    expected = [law.ramp, law.ramp + law.cruise] if law.cruise > 0.0 else [law.ramp]
    np.testing.assert_allclose(law.times_at(np.array(inner)), expected, rtol=1e-9)


def test_between_knots_the_least_acc_of_all_phases_counts() -> None:
    """Three sections with bounds of their own; some knots lie on their borders, others miss them."""
    bounds = Sections(
        np.array([0.1, 0.05, 0.2]), np.full(3, 0.3), np.array([2.0, 0.4, 1.0]), np.full(3, np.inf)
    )
    law = fastest_trapezoids(bounds, 0.35)
    assert acc_between(law, np.array([0.0, 0.05, 0.1, 0.15, 0.25, 0.35])).tolist() == [
        2.0,
        2.0,
        0.4,
        1.0,
        1.0,
    ]
    assert acc_between(law, np.array([0.0, 0.09, 0.11, 0.14, 0.2, 0.35])).tolist() == [
        2.0,
        0.4,
        0.4,
        0.4,
        1.0,
    ]
    assert acc_between(law, np.array([0.05, 0.2])).tolist() == [0.4]
    assert acc_between(LAWS["trapezoid"], np.array([0.0, 0.2, 0.4])) == pytest.approx([1.5, 1.5])
