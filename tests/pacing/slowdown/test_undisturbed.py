"""Knots of a dry run, all at once: those of the elastic walk where nothing bites, else none."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.pacing.slowdown.reserve import RESERVE, reserved
from irlx.pacing.slowdown.undisturbed import undisturbed_postures
from irlx.robot.limits import JointLimits
from irlx.transform.criteria.least_motion import LeastMotion
from machines import machine
from slow_cases import free_rows, grid_of, used, walked

pytestmark = pytest.mark.req("MOT-21")

robots = pytest.mark.parametrize("name", ["arm7", "koch11"])


def found(name: str, limits: JointLimits, off: float = 0.02) -> np.ndarray | None:
    robot, grid = machine(name), grid_of(name)
    guess = free_rows(name) + off * np.sin(np.arange(grid.intervals + 1))[:, None]
    guess[0] = robot.start
    least = LeastMotion(robot.weights)
    bounds = reserved(limits, grid.intervals + 1, RESERVE)
    return undisturbed_postures(robot.model(limits), grid, guess, lambda s, _: least, bounds, RESERVE)


@robots
def test_without_bounds_they_are_those_of_the_walk(name: str) -> None:
    """The walk goes by the null space at the end of each step, this by both: apart by its error."""
    limits = machine(name).unlimited()
    apart = np.max(np.abs(found(name, limits) - walked(name, limits).q))
    way = np.max(np.abs(np.diff(free_rows(name), axis=0)))
    assert apart < way**2 * grid_of(name).intervals


@robots
def test_speeds_and_positions_that_bite_are_left_to_the_walk(name: str) -> None:
    wide, rows = machine(name).unlimited(), free_rows(name)
    for share, easy in ((1.2, True), (0.9, False)):
        fast = share * used(name)
        assert (found(name, wide.with_pair("speed", -fast, fast)) is not None) == easy
    joint = int(np.argmax(np.ptp(rows, axis=0)))
    for room, easy in ((0.1, True), (-0.01, False)):
        upper = np.full(machine(name).n, np.inf)
        lower = -upper
        upper[joint], lower[joint] = rows[:, joint].max() + room, rows[:, joint].min() - room
        upper[joint] = max(upper[joint], rows[0, joint])
        lower[joint] = min(lower[joint], rows[0, joint])
        assert (found(name, wide.with_pair("position", lower, upper)) is not None) == easy


def test_a_guess_that_leads_nowhere_is_no_posture() -> None:
    assert found("arm7", machine("arm7").unlimited(), off=3.0) is None
