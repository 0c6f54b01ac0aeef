"""Rows of joint moves are judged by differences before anybody gets them."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from irlx.blocks import PoseTarget
from irlx.diagnostics import Place
from irlx.pacing.errors import PacingError
from irlx.pacing.joint_moves import _check_rows, _programmed
from irlx.pacing.resolution import RowTicks

PLACE = Place("t.irl")
DT = 0.01
TICKING = RowTicks(1, DT)


def test_rows_within_their_limits_pass(kit, shop) -> None:
    q = kit.start + np.outer([0.001, 0.003, 0.004], np.eye(7)[2])
    _check_rows(shop.pacer._situation, q, kit.limits(5.0, 0.3, 20.0), TICKING, PLACE)


def test_a_row_that_is_too_fast_is_refused_and_told(kit, shop) -> None:
    """The second row goes 3 mm in 10 ms, 0.3 m/s; the first row is that of tick 1."""
    q = kit.start + np.outer([0.001, 0.004, 0.005], np.eye(7)[2])
    with pytest.raises(PacingError) as caught:
        _check_rows(shop.pacer._situation, q, kit.limits(5.0, 0.2), TICKING, PLACE)
    reason = caught.value.reason
    assert (reason.code, reason.data["joint"], reason.data["kind"]) == ("IRL523", "y", "speed")
    assert (reason.data["value"], reason.data["bound"], reason.data["tick"]) == ("300 mm/s", "200 mm/s", 2)


def test_the_stop_is_judged_too(kit, shop) -> None:
    """It would come from 0.1 m/s to rest in one tick of 10 ms: 10 m/s2."""
    q = kit.start + np.outer([0.0005, 0.0015], np.eye(7)[0])
    with pytest.raises(PacingError) as caught:
        _check_rows(shop.pacer._situation, q, kit.limits(5.0, np.inf, 6.0), TICKING, PLACE)
    reason = caught.value.reason
    assert (reason.data["joint"], reason.data["kind"], reason.data["tick"]) == ("rail", "acceleration", 3)


def test_a_ptp_within_bands_is_programmed_as_its_frame_sees_the_tool() -> None:
    """A target without an orientation keeps that of the tool in the frame; without bands there is nothing."""
    turned = np.diag([-1.0, -1.0, 1.0])
    framed = SimpleNamespace(pose=(turned, np.ones(3)))
    situation = SimpleNamespace(
        pose=(np.eye(3), np.zeros(3)),
        locate=lambda origin: PLACE,
        in_frame=lambda frame, place: framed if (frame, place) == ("table", PLACE) else None,
    )
    target = PoseTarget((0.1, 0.2, 0.3), None)
    block = SimpleNamespace(tolerance="bands", frame="table", origin=None, target=target)
    found = _programmed(situation, block)
    assert found is not None
    np.testing.assert_array_equal(found[0], turned)
    np.testing.assert_array_equal(found[1], [0.1, 0.2, 0.3])
    block.tolerance = None
    assert _programmed(situation, block) is None
