"""When the steps of a tick are over: the rest of a geometric series, the pose met, rounding."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.transform.precision import (
    MOST_CALM_STEPS,
    ORIENTATION_TOLERANCE,
    POSITION_TOLERANCE,
    ROUNDING_STEP,
    SETTLED_ERROR,
    SETTLED_STEP,
)
from irlx.transform.settling import Settling, is_met, settles_at_once

pytestmark = pytest.mark.req("TRF-01")


@pytest.mark.parametrize("pull", [1e-6, 0.01, 0.05, 0.3])
def test_a_step_is_the_last_where_all_that_would_follow_is_next_to_nothing(pull: float) -> None:
    """Steps that shrink by the share 5 x pull (at most a half) leave size x share / (1 - share)."""
    share = min(5.0 * pull, 0.5)
    most = min(SETTLED_ERROR * (1.0 - share) / share, SETTLED_STEP)
    assert settles_at_once(0.99 * most, pull)
    assert Settling().after(0.99 * most, pull, True)
    if 1.01 * most > ROUNDING_STEP:
        assert not settles_at_once(1.01 * most, pull)
        assert not Settling().after(1.01 * most, pull, True)


def test_what_two_steps_show_counts_where_it_is_more() -> None:
    """From 1E-10 to 0.9E-10: they shrink by a tenth only, nine times as much is to follow."""
    for first, second, done in ((1e-10, 0.9e-10, False), (1e-6, 1e-12, True), (1e-12, 3e-12, False)):
        settling = Settling()
        assert not settling.after(first, 1e-6, False)
        assert settling.after(second, 1e-6, True) is done


def test_the_largest_of_all_shares_counts() -> None:
    settling = Settling()
    for size in (1e-8, 0.8e-8, 1e-12):
        done = settling.after(size, 1e-6, True)
    # 1E-12 after 0.8E-8 is a share of next to nothing; 0.8 was seen before: 4E-12 may be left.
    assert not done


def test_long_steps_and_poses_that_are_off_are_not_the_end() -> None:
    assert not Settling().after(2.0 * SETTLED_STEP, 0.0, True)
    assert not Settling().after(0.0, 0.0, False)
    assert Settling().after(0.0, 0.3, True)
    assert Settling().after(ROUNDING_STEP, 0.3, True)
    assert not settles_at_once(2.0 * SETTLED_STEP, 0.0)


def test_a_few_steps_of_the_same_small_size_are_enough() -> None:
    settling = Settling()
    assert [settling.after(1e-10, 0.1, True) for _ in range(MOST_CALM_STEPS)] == [
        *[False] * (MOST_CALM_STEPS - 1),
        True,
    ]


@pytest.mark.parametrize(
    ("at", "angles", "met"),
    [
        ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), True),
        ((0.6, 0.0, 0.8), (0.0, 0.6, 0.8), True),
        ((0.61, 0.0, 0.8), (0.0, 0.0, 0.0), False),
        ((0.0, 0.0, 0.0), (0.0, 0.61, 0.8), False),
        ((0.7, 0.7, 0.7), (0.0, 0.0, 0.0), False),
        ((0.9, 0.0, 0.0), (0.9, 0.0, 0.0), True),
    ],
)
def test_a_pose_is_met_by_the_lengths_of_both_parts(at, angles, met: bool) -> None:
    """In units of the tolerances, a little less where one stands exactly on them."""
    shrunk = 1.0 - 1e-12
    parts = POSITION_TOLERANCE * np.array(at), ORIENTATION_TOLERANCE * np.array(angles)
    assert is_met(shrunk * np.concatenate(parts), 3) is met


def test_a_task_of_fewer_coordinates_counts_its_own_parts() -> None:
    assert is_met(np.array([0.9 * POSITION_TOLERANCE, 0.9 * ORIENTATION_TOLERANCE]), 1)
    assert not is_met(np.array([0.9 * POSITION_TOLERANCE, 0.9 * POSITION_TOLERANCE]), 2)
