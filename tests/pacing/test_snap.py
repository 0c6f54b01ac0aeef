"""Bounds that mean the present posture, read in degrees and handed back, are put on it."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.blocks import (
    JointRange,
    JointTarget,
    LimitClause,
    LimitKind,
    LimitSwitchBlock,
    MoveBlock,
    MoveKind,
    WaitBlock,
)
from irlx.pacing.snap import snapped

Q = np.array([0.1, -0.2, 0.7, 1.1, 0.0, -1.3, 0.4])
NEAR = JointRange(tuple((Q - 5e-13).tolist()), tuple((Q + 2.0).tolist()))
"""Lower bounds that mean Q, upper ones that do not."""
MEANT = JointRange(tuple(Q.tolist()), NEAR.upper)


@pytest.mark.parametrize(("kind", "expected"), [(LimitKind.POSITION, MEANT), (LimitKind.SPEED, NEAR)])
def test_of_a_switch_and_of_a_clause_positions_alone_are_put_on_the_posture(shop, kind, expected):
    switch = LimitSwitchBlock(**shop._data(), kind=kind, range=NEAR)
    assert snapped(switch, Q).range == expected
    clause = LimitClause(kind, NEAR, shop.origin(1))
    target, law = JointTarget(MEANT.lower), shop.law()
    move = MoveBlock(**shop._data(), kind=MoveKind.PTP, target=target, law=law, limits=(clause,))
    (found,) = snapped(move, Q).limits
    assert found.range == expected


def test_what_has_no_bounds_stays_as_it_is(shop):
    ended = LimitSwitchBlock(**shop._data(), kind=LimitKind.POSITION, range=None)
    wait = WaitBlock(**shop._data(), duration=0.05)
    assert snapped(ended, Q) is ended
    assert snapped(wait, Q) is wait
