"""Rungs of smoothing: order, when to stop, what smoothing is worth, and no rung beyond a limit."""

from __future__ import annotations

import itertools
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

from irlx.pacing.slowdown import ladder
from irlx.pacing.slowdown.clock import PlannedClock, plan_clock
from irlx.pacing.slowdown.clock_bounds import clock_bounds
from irlx.pacing.slowdown.curve import JointCurve
from irlx.pacing.slowdown.ladder import RUNGS, TimedCurve, timed_curves
from irlx.pacing.slowdown.reserve import RESERVE, reserved
from irlx.robot.limits import JointLimits
from long_run import first
from machines import machine
from slow_cases import SPEEDS, free_rows, grid_of, slow_limits, used, walked

pytestmark = pytest.mark.req("MOT-21")

robots = pytest.mark.parametrize("name", first(1, ["arm7", "koch11"]))


def rungs(name: str, limits: JointLimits, q: np.ndarray | None = None) -> list[TimedCurve]:
    grid = grid_of(name)
    q = walked(name, limits).q if q is None else q
    bounds = reserved(limits, grid.intervals + 1, RESERVE)
    return list(timed_curves(machine(name).model(limits), grid, q, bounds, SPEEDS[name][1]))


@cache
def slow_rungs(name: str, tamed: bool = True) -> list[TimedCurve]:
    """The rungs of the usual slow case, its acceleration limits left out where it is not tamed."""
    return rungs(name, slow_case(name, tamed))


@cache
def slow_case(name: str, tamed: bool = True) -> JointLimits:
    limits, none = slow_limits(name, 0.5), np.full(machine(name).n, np.inf)
    return limits if tamed else limits.with_pair("acceleration", -none, none)


@robots
def test_all_rungs_are_tried_and_come_fastest_first(name: str) -> None:
    found = slow_rungs(name)
    times = [timed.clock.duration for timed in found]
    assert len(found) >= 2
    assert times == sorted(times)


def test_smoothing_is_worth_its_while() -> None:
    """Kinks of the bare walk under narrow acceleration limits: the best rung is at least 3 % faster."""
    name = "koch11"
    limits, grid = slow_limits(name, 0.8, cut=False), grid_of(name)
    hard = np.full(machine(name).n, 0.5)
    limits = limits.with_pair("acceleration", -hard, hard)
    bare = JointCurve(grid.s, walked(name, limits).q)
    clock = plan_clock(clock_bounds(bare, limits, grid.rates, SPEEDS[name][1]))
    assert rungs(name, limits)[0].clock.duration < 0.97 * clock.duration


@robots
def test_a_walk_that_loses_nothing_is_taken_as_it_is(name: str) -> None:
    fast = 2.0 * used(name) + 0.1
    limits = machine(name).unlimited().with_pair("speed", -fast, fast)
    limits = limits.with_pair("acceleration", -1e3 * fast, 1e3 * fast)
    found = rungs(name, limits)
    assert len(found) == 1
    np.testing.assert_allclose(found[0].curve.q, free_rows(name), atol=1e-9)


@robots
@pytest.mark.req("MOT-20")
def test_no_rung_leaves_a_position_limit(name: str) -> None:
    limits = slow_case(name)
    for timed in slow_rungs(name):
        s = timed.curve.s
        q = timed.curve.at(np.linspace(0.0, s[-1], 5001))
        assert np.max(np.maximum(q - limits.position_upper, limits.position_lower - q)) <= 1e-9


def test_postures_outside_have_no_rung() -> None:
    rows = free_rows("arm7")
    upper = np.where(np.arange(7) == 3, rows[:, 3].max() - 0.5 * np.ptp(rows[:, 3]), np.inf)
    limits = machine("arm7").unlimited().with_pair("position", -np.full(7, np.inf), upper)
    limits = limits.with_pair("acceleration", -np.full(7, 50.0), np.full(7, 50.0))
    assert all(np.max(timed.curve.q[:, 3]) <= upper[3] + 1e-9 for timed in rungs("arm7", limits, rows))


@pytest.mark.parametrize("name", ["arm7"])
def test_without_accelerations_a_smooth_rung_comes_first(name: str) -> None:
    """Nothing tames the kinks of the walk there: it is taken only where it is 0.5 % faster."""
    found, walk = slow_rungs(name, False), walked(name, slow_case(name, False)).q
    bare = [timed for timed in found if np.array_equal(timed.curve.q, walk)]
    smooth = min(t.clock.duration for t in found if all(t is not b for b in bare))
    if any(found[0] is timed for timed in bare):
        assert found[0].clock.duration * 1.005 <= smooth
    else:
        assert found[0].clock.duration == smooth


def test_a_dry_run_passes_over_rungs_that_gain_nothing() -> None:
    """It takes the fastest of what it tries first; asked on and on, it gives all that a run has."""
    name = "arm7"
    limits, grid = slow_limits(name, 0.5), grid_of(name)
    bounds = reserved(limits, grid.intervals + 1, RESERVE)
    model, acc = machine(name).model(limits), SPEEDS[name][1]
    walk = walked(name, limits).q
    thrifty = list(timed_curves(model, grid, walk, bounds, acc, (), 0.0, 3e-3))
    durations = [timed.clock.duration for timed in slow_rungs(name)]
    assert sorted(timed.clock.duration for timed in thrifty) == durations
    assert thrifty[0].clock.duration <= 1.01 * durations[0]
    alone = next(timed_curves(model, grid, walk, bounds, acc, (), 0.0, 3e-3, False))
    assert np.array_equal(alone.curve.q, walk)


def stand_still_clock(duration: float) -> PlannedClock:
    """A clock of one interval from rest at rate 2 / duration to its end: it takes that long."""
    x = np.array([0.0, (2.0 / duration) ** 2])
    return PlannedClock(np.array([0.0, 1.0]), x, np.zeros(2, np.int8), np.zeros(2, np.int16))


@pytest.mark.parametrize(
    ("least_gain", "durations", "tried"),
    [
        # A run tries the lightest smoothing first, and all of it until one loses nothing.
        (0.0, [1.5, 1.4, 1.3, 1.2], [None, *RUNGS[1:]]),
        (0.0, [1.5, 1.0, 0.5, 0.5], [None, RUNGS[1]]),
        (0.0, [1.0, 0.5, 0.5, 0.5], [None]),
        # A dry run asks the strongest first, and goes on only while that gains what it must.
        (0.01, [1.5, 1.4, 1.3, 1.2], [None, *RUNGS[:0:-1]]),
        (0.01, [1.5, 1.495, 1.3, 1.2], [None, RUNGS[3]]),
        (0.01, [1.5, 1.6, 1.3, 1.2], [None, RUNGS[3]]),
        (0.01, [1.5, 1.4, 1.399, 1.2], [None, RUNGS[3], RUNGS[2]]),
    ],
)
def test_rungs_are_tried_in_turn_until_one_is_told(least_gain, durations, tried, monkeypatch) -> None:
    """`durations` of the rungs in the order in which they are tried, the programme taking 1 s."""
    seen: list[object] = []

    def timed(model, grid, walked, bounds, acc, rung, pinned, reserve, smooth):
        seen.append(rung)
        return TimedCurve(None, stand_still_clock(durations[len(seen) - 1]))

    monkeypatch.setattr(ladder, "_timed", timed)
    limits = machine("arm7").unlimited().with_pair("acceleration", -np.ones(7), np.ones(7))
    grid = SimpleNamespace(times=np.array([0.25, 0.75]))
    curves = timed_curves(machine("arm7").model(limits), grid, None, None, 1.0, (), 0.0, least_gain)
    first = next(curves)
    assert seen == tried
    assert first.clock.duration == pytest.approx(min(durations[: len(tried)]))


def test_a_curve_is_held_against_what_is_kept_clear_at_its_knots_and_between_them() -> None:
    """At its own start, and at the times at which the programme is there."""
    asked = []

    def first_short(q, start, elapsed):
        asked.append((q, start, elapsed))

    grid = grid_of("arm7")
    curve = JointCurve(grid.s, free_rows("arm7"))
    clearance = SimpleNamespace(first_short=first_short)
    model = replace(machine("arm7").model(), clearance=clearance)
    assert ladder._clear(model, grid, curve)
    ((q, start, elapsed),) = asked
    assert np.array_equal(start, machine("arm7").start)
    between = [0.5 * (a + b) for a, b in itertools.pairwise(grid.s)]
    places = np.array(sorted([*grid.s[1:-1].tolist(), *between]))
    np.testing.assert_allclose(ladder.places_between(grid), places, atol=1e-15)
    np.testing.assert_allclose(q, curve.at(places), atol=1e-12)
    times = np.concatenate([[0.0], np.cumsum(grid.times)])
    np.testing.assert_allclose(elapsed[1::2], times[1:-1], atol=1e-12)
    np.testing.assert_allclose(elapsed[::2], 0.5 * (times[1:] + times[:-1]), atol=1e-12)
