"""What the report of corrections counts."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.pacing.correction.approach import TOO_NEAR, TOOL, Governor
from irlx.pacing.correction.report import CorrectionReport, Lag
from irlx.pacing.correction.tally import DELAYED, Tally
from irlx.transform.step_bounds import BoundSource


def test_nothing_at_first() -> None:
    assert Tally(("a", "b")).report == CorrectionReport()


def test_ticks_and_answers_and_waiting() -> None:
    tally = Tally(("a", "b"))
    for answered in (True, False, True):
        tally.asked(answered)
    tally.held()
    tally.held()
    assert tally.report == CorrectionReport(ticks=3, requests=2, held_ticks=2)


def test_the_largest_lag_of_each_part_is_kept_with_its_tick() -> None:
    tally = Tally(("a", "b"))
    slow = Governor(1, BoundSource.SPEED)
    tally.ended(np.array([3e-3, 0, 4e-3, 0, 0, 0]), 5, 12, slow)
    tally.ended(np.array([0, 2e-3, 0, 0.2, 0, 0]), 6, 13, Governor(TOOL, BoundSource.ACCELERATION), True)
    tally.ended(np.array([0, 0, 0, 0, 0.1, 0]), 7, 13, slow, True)
    assert tally.report == CorrectionReport(
        delayed_ticks=3,
        refused_ticks=2,
        position_lag=Lag(5e-3, 5, 12, "b", "speed"),
        orientation_lag=Lag(0.2, 6, 13, "", "tool acceleration"),
    )


@pytest.mark.parametrize("left", [0.0, DELAYED])
def test_rounding_is_no_lag(left: float) -> None:
    tally = Tally(("a",))
    tally.ended(np.array([left, 0, 0, 0, 0, left]), 5, 12, None, True)
    assert tally.report == CorrectionReport()


def test_a_part_that_is_there_has_no_lag() -> None:
    tally = Tally(("a",))
    tally.ended(np.array([0, 0, 0, 0, 0, 0.01]), 5, 12, TOO_NEAR)
    assert tally.report.position_lag is None
    assert tally.report.orientation_lag == Lag(0.01, 5, 12, "", "clearance")
    tally.ended(np.array([0, 0, 0.01, 0, 0, 0.0]), 6, 12)
    assert tally.report.position_lag == Lag(0.01, 6, 12, "", "")


@pytest.mark.parametrize(
    ("source", "word"),
    [
        (BoundSource.POSITION, "position"),
        (BoundSource.SPEED, "speed"),
        (BoundSource.ACCELERATION, "acceleration"),
        (BoundSource.BRAKING, "braking"),
    ],
)
def test_words_of_bounds(source: BoundSource, word: str) -> None:
    tally = Tally(("a",))
    tally.ended(np.array([1.0, 0, 0, 0, 0, 0]), 1, 1, Governor(0, source))
    assert (tally.report.position_lag.joint, tally.report.position_lag.bound) == ("a", word)
