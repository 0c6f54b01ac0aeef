"""programs/two_walls: a corridor in which both walls push at once; the arm passes and does not oscillate.

Distances are measured anew from the URDF and the cell (tests/support/nearness.py).

What oscillates changes the sign of its acceleration over and over, the more often the shorter the tick. A
line with ramps needs few changes: speeding up, the cruise, slowing down. Counted are those between
accelerations of more than 2 % of the joint's largest, by time. What goes to and fro has speeds that vary
more: a criterion that lets the nearest wall alone count makes them vary 1.5 times as much as least motion
does, this one 1.33 times.
"""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import irlx
from nearness import least, nearest

pytestmark = pytest.mark.req("TRF-13")

FOLDER = Path(__file__).parents[1] / "programs" / "two_walls"
CELL = FOLDER / "two_walls.toml"
TICKS = [5, 10, 20, 50]
MARGIN = 0.020
MOST_CHANGES = 4.0
"""Sign changes of a joint's acceleration per second; the runs have 1.2 to 2.9, an oscillation 10 and more."""

every_tick = pytest.mark.parametrize(
    "tick", [pytest.param(tick, marks=() if tick in (10, 50) else pytest.mark.slow) for tick in TICKS]
)


@cache
def run_of(name: str, tick: int) -> irlx.Run:
    return irlx.run(FOLDER / f"{name}.irl", tick_ms=tick)


@cache
def distances(name: str, tick: int) -> dict[tuple[str, str], np.ndarray]:
    return nearest(run_of(name, tick), CELL)


def sign_changes(acceleration: np.ndarray, seconds: float) -> np.ndarray:
    """Sign changes per second of each column (N, n), of values beyond 2 % of the column's largest."""
    found = []
    for column in acceleration.T:
        signs = np.sign(column[np.abs(column) > 0.02 * np.abs(column).max()])
        found.append(np.count_nonzero(np.diff(signs)) / seconds)
    return np.array(found)


def variation(run: irlx.Run) -> np.ndarray:
    """Total variation of each joint's speed, rad/s."""
    return np.sum(np.abs(np.diff(run.qd, axis=0)), axis=0)


def test_the_measure_tells_an_oscillation_from_a_ramp() -> None:
    t = np.arange(0.0, 5.0, 0.01)
    ramps = np.where(t < 0.5, 1.0, np.where(t > 4.5, -1.0, 0.0))
    shaken = ramps + 0.1 * np.where(np.arange(t.size) % 4 < 2, 1.0, -1.0)
    few, many = sign_changes(np.column_stack([ramps, shaken]), 5.0)
    assert few < 0.5
    assert many > 10.0 * MOST_CHANGES


@pytest.mark.parametrize("name", ["two_walls", "two_walls_plain"])
def test_it_runs_without_a_word_and_verifies(name: str) -> None:
    run = run_of(name, 10)
    assert run.complete
    assert [str(told) for told in run.diagnostics] == []
    assert irlx.check(FOLDER / f"{name}.irl", cell=CELL) == []
    assert irlx.verify(run, program=FOLDER / f"{name}.irl", cell=CELL).passed


def test_with_least_motion_it_runs_into_the_left_wall() -> None:
    found = distances("two_walls_plain", 10)
    assert least(found) == pytest.approx(-0.0327, abs=5e-4)
    assert min(found, key=lambda pair: found[pair].min()) == ("link_1", "left_wall")


@every_tick
def test_the_margin_holds_and_both_walls_are_near(tick: int) -> None:
    found = distances("two_walls", tick)
    assert least(found) >= MARGIN
    for wall in ("left_wall", "right_wall"):
        assert min(rows.min() for (_, other), rows in found.items() if other == wall) < 0.05
        # Felt in every row: the influence is 0.4 m.
        assert np.min([rows for (_, other), rows in found.items() if other == wall], axis=0).max() < 0.4


@every_tick
def test_it_does_not_oscillate(tick: int) -> None:
    run = run_of("two_walls", tick)
    assert sign_changes(run.qdd, float(run.t[-1])).max() < MOST_CHANGES
    assert run.summary.slowed == ()


@every_tick
def test_speeds_vary_no_more_at_this_tick_than_at_others(tick: int) -> None:
    """Total variation of the speeds: at most 1.4 times that of least motion, and the same at every tick."""
    run, plain = run_of("two_walls", tick), run_of("two_walls_plain", tick)
    assert np.sum(variation(run)) < 1.4 * np.sum(variation(plain))
    np.testing.assert_allclose(variation(run), variation(run_of("two_walls", 10)), rtol=0.1)


@every_tick
def test_the_posture_hardly_depends_on_the_tick(tick: int) -> None:
    ends = [run_of("two_walls", other).q[-1] for other in (tick, 10)]
    assert np.max(np.abs(ends[0] - ends[1])) < np.radians(2.0)


@pytest.mark.req("MOT-20")
@every_tick
def test_the_tool_is_on_its_lines(tick: int) -> None:
    run, plain = run_of("two_walls", tick), run_of("two_walls_plain", tick)
    np.testing.assert_array_equal(run.t, plain.t)
    np.testing.assert_allclose(run.tool, plain.tool, atol=1e-9)
    corners = np.array([[1.0, 0.0], [0.76, 0.0], [1.0, 0.03], [0.76, -0.03], [1.0, 0.0]])
    for row in run.tool[:, :2]:
        away = []
        for a, b in pairwise(corners):
            share = np.clip((row - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
            away.append(np.linalg.norm(a + share * (b - a) - row))
        assert min(away) < 1e-6
