"""What two blends leave of a path."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.motion.line import Line
from irlx.motion.path_part import PathPart
from irlx.motion.sections import Shape

LINE = Line(np.zeros(3), np.eye(3), np.array([2.0, 0.0, 0.0]), np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]]))
PART = PathPart(LINE, 0.5, 1.25, Shape(*(np.array([value]) for value in (0.75, 0.0, 0.0, 0.0))))


@pytest.mark.req("MOT-06")
def test_it_is_counted_from_its_own_start() -> None:
    s = np.array([0.0, 0.25, 0.75])
    assert PART.length == 0.75
    np.testing.assert_array_equal(PART.poses(s).position[:, 0], [0.5, 0.75, 1.25])
    np.testing.assert_array_equal(PART.poses(s).rotation, LINE.poses(s + 0.5).rotation)


@pytest.mark.req("MOT-06")
def test_rounding_beyond_an_end_stays_at_it() -> None:
    """A time law may be an ulp longer than the way: the pose is then that of the end, not one beyond."""
    beyond = PART.poses(np.array([-1e-9, 0.75 + 1e-9]))
    np.testing.assert_array_equal(beyond.position[:, 0], [0.5, 1.25])
