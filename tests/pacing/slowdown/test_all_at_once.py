"""Which criteria postures of many poses at once can follow."""

from __future__ import annotations

import numpy as np

from irlx.pacing.slowdown.all_at_once import references
from irlx.transform.criteria.least_motion import LeastMotion
from irlx.transform.criteria.posture import Posture

WEIGHTS = np.array([2.0, 1.0])


class OfItsOwn(LeastMotion):
    """Looks like least motion, and may be anything."""


def test_least_motion_draws_to_nothing() -> None:
    assert references([LeastMotion(WEIGHTS)] * 3).size == 0


def test_postures_are_those_of_the_criteria() -> None:
    drawn = [np.array([0.1, 0.2]), np.array([0.3, -0.4])]
    np.testing.assert_array_equal(references([Posture(WEIGHTS, q) for q in drawn]), drawn)


def test_others_and_mixed_ones_are_followed_one_after_another() -> None:
    least, posture = LeastMotion(WEIGHTS), Posture(WEIGHTS, np.zeros(2))
    assert references([least, posture]) is None
    assert references([posture, posture, least]) is None
    assert references([OfItsOwn(WEIGHTS)]) is None
