"""Where a robot would stand behind a move that it cannot do."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.blocks import JointIncrement, JointTarget, MoveBlock, MoveKind, PoseTarget
from irlx.diagnostics import Place
from irlx.pacing.beyond import posture_beyond
from irlx.pacing.errors import PacingError

PLACE = Place("t.irl")


def beyond(shop, target, kind: MoveKind = MoveKind.PTP) -> np.ndarray:
    situation = shop.pacer._situation
    move = MoveBlock(**shop._data(), kind=kind, target=target, law=shop.law())
    return posture_beyond(situation, move, situation.in_force(), PLACE)


@pytest.mark.parametrize("kind", [MoveKind.PTP, MoveKind.LIN])
def test_behind_a_posture_and_behind_an_increment(kit, shop, kind: MoveKind) -> None:
    way = np.array([0.5, 0.25, -1.0, 0.0, 0.125, 0.0, 2.0])
    values = tuple((kit.start + way).tolist())
    assert beyond(shop, JointTarget(values), kind).tolist() == list(values)
    assert beyond(shop, JointIncrement(tuple(way.tolist())), kind).tolist() == list(values)


def test_behind_an_increment_beyond_a_limit_is_nowhere(shop) -> None:
    with pytest.raises(PacingError):
        beyond(shop, JointIncrement((6.0, *[0.0] * 6)))


def test_behind_a_pose_is_the_nearest_posture(kit, shop) -> None:
    """The rail, three times as heavy, goes a quarter of the way."""
    found = beyond(shop, PoseTarget(tuple(kit.beyond(0.4, 0.2, -0.1).tolist()), None), MoveKind.LIN)
    np.testing.assert_allclose(found, kit.moved(0.1, 0.3, 0.2, -0.1, 0.0, 0.0, 0.0), atol=1e-9)
