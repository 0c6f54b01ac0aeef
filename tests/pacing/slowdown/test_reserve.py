"""Bounds narrowed for a curve that swings between knots, and rounding put back."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.pacing.slowdown.reserve import LEAD, reserved, rounded_inside
from irlx.robot.limits import JointLimits

pytestmark = pytest.mark.req("MOT-20")

LIMITS = JointLimits.unlimited(3).with_pair(
    "position", np.array([-1.0, 0.0, -np.inf]), np.array([1.0, 2e-4, np.inf])
)


def test_reserve_grows_from_nothing_at_both_ends() -> None:
    lower, upper = reserved(LIMITS, 60, 1e-4)
    assert (lower[0, 0], upper[0, 0], lower[-1, 0], upper[-1, 0]) == (-1.0, 1.0, -1.0, 1.0)
    assert lower[LEAD : 60 - LEAD, 0] == pytest.approx(-1.0 + 1e-4, rel=1e-15)
    assert np.all(np.diff(lower[: LEAD + 1, 0]) > 0.0)
    np.testing.assert_allclose(1.0 - upper[:, 0], lower[:, 0] + 1.0, atol=1e-15)


def test_a_narrow_range_keeps_half_its_width_and_an_infinite_one_is_infinite() -> None:
    lower, upper = reserved(LIMITS, 60, 1e-4)
    assert (upper - lower)[:, 1].min() == pytest.approx(1e-4, rel=1e-9)
    assert np.all(np.isinf(lower[:, 2]) & np.isinf(upper[:, 2]))


def test_no_reserve_leaves_the_limits() -> None:
    lower, upper = reserved(LIMITS, 50, 0.0)
    assert np.all(lower == LIMITS.position_lower)
    assert np.all(upper == LIMITS.position_upper)


def test_only_rounding_is_put_back_onto_a_limit() -> None:
    q = np.array([[1.0 + 2e-16, 1e-4, 9.0], [1.0 + 1e-9, 1e-4, 9.0], [-1.0 - 1e-13, 0.0, 9.0]])
    inside = rounded_inside(q, LIMITS)
    assert inside[:, 0].tolist() == [1.0, 1.0 + 1e-9, -1.0]
    assert np.all(inside[:, 1:] == q[:, 1:])
