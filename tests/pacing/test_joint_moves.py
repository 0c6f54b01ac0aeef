"""Rows of joint moves are judged by differences before anybody gets them."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.diagnostics import Place
from irlx.pacing.errors import PacingError
from irlx.pacing.joint_moves import _check_rows

PLACE = Place("t.irl")
DT = 0.01


def test_rows_within_their_limits_pass(kit, shop) -> None:
    q = kit.start + np.outer([0.001, 0.003, 0.004], np.eye(7)[2])
    _check_rows(shop.pacer._situation, q, kit.limits(5.0, 0.3, 20.0), DT, PLACE)


def test_a_row_that_is_too_fast_is_refused_and_told(kit, shop) -> None:
    """The second row goes 3 mm in 10 ms, 0.3 m/s; the first row is that of tick 1."""
    q = kit.start + np.outer([0.001, 0.004, 0.005], np.eye(7)[2])
    with pytest.raises(PacingError) as caught:
        _check_rows(shop.pacer._situation, q, kit.limits(5.0, 0.2), DT, PLACE)
    reason = caught.value.reason
    assert (reason.code, reason.data["joint"], reason.data["kind"]) == ("IRL523", "y", "speed")
    assert (reason.data["value"], reason.data["bound"], reason.data["tick"]) == ("300 mm/s", "200 mm/s", 2)


def test_the_stop_is_judged_too(kit, shop) -> None:
    """It would come from 0.1 m/s to rest in one tick of 10 ms: 10 m/s2."""
    q = kit.start + np.outer([0.0005, 0.0015], np.eye(7)[0])
    with pytest.raises(PacingError) as caught:
        _check_rows(shop.pacer._situation, q, kit.limits(5.0, np.inf, 6.0), DT, PLACE)
    reason = caught.value.reason
    assert (reason.data["joint"], reason.data["kind"], reason.data["tick"]) == ("rail", "acceleration", 3)
