"""Ticks whose step is not found from where they start."""

import numpy as np
import pytest

from irlx.transform.criteria.least_motion import LeastMotion
from irlx.transform.second_start import middle_of_bounds
from irlx.transform.step_bounds import StepBounds


def test_the_middle_is_that_of_narrow_bounds_and_the_start_elsewhere():
    lower = np.array([-0.1, -np.inf, -2.0, 0.0, 3.0])
    upper = np.array([0.3, np.inf, 1.0, 0.0, 4.0])
    (middle,) = middle_of_bounds(StepBounds(lower, upper))
    np.testing.assert_allclose(middle, [0.1, 0.0, 0.0, 0.0, 3.0], atol=1e-16)


def test_bounds_that_are_wide_have_no_middle():
    """Another posture, as far away as a joint's range is wide, is no step of a tick."""
    assert middle_of_bounds(StepBounds(np.full(3, -1.0), np.full(3, 1.0))) == []


@pytest.mark.req("TRF-02")
@pytest.mark.parametrize(("beside", "found"), [(0.0, True), (3e-13, True), (1e-9, False)])
def test_a_pose_that_bounds_touch_but_for_rounding_is_met(arm, beside: float, found: bool) -> None:
    """Bounds leave one step: its pose is met as nearly as they let, and no other one is."""
    step = np.random.default_rng(5).uniform(-0.01, 0.01, arm.n)
    rotation, position = arm.kinematics.tool_pose(arm.q + step)
    target = arm.kinematics.target(rotation, position + np.array([0.0, beside, 0.0]))
    solution = arm.solve(target, LeastMotion(arm.weights), StepBounds(step, step))
    assert solution.solved is found
    if found:
        np.testing.assert_array_equal(solution.q, arm.q + step)
