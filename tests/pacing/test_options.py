"""Which options hold for a move: switches overlap in any order, a clause overrides, nothing widens."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest

from irlx.blocks import CyclicBlock, FreezeBlock, LimitClause, LimitKind, LimitSwitchBlock, Origin
from irlx.pacing.options import Options, limits_in_force

pytestmark = pytest.mark.req("LANG-60")

HERE = Origin("cell.irl", 0, 4, 1)
THERE = Origin("cell.irl", 7, 11, 2)
Q = np.arange(7.0)


def switch(kit, kind: LimitKind, half: float | None) -> LimitSwitchBlock:
    return LimitSwitchBlock(id=1, origin=HERE, kind=kind, range=None if half is None else kit.range(half))


def freeze(*joints: int) -> FreezeBlock:
    return FreezeBlock(id=2, origin=HERE, joints=joints)


def cyclic(active: bool) -> CyclicBlock:
    return CyclicBlock(id=3, origin=HERE, active=active)


def test_switching_on_and_off_in_any_order_gives_the_same_state(kit) -> None:
    """Every order of five switch-ons, then of three switch-offs: each off ends its own kind alone."""
    on = [switch(kit, kind, 1.0 + i) for i, kind in enumerate(LimitKind)] + [freeze(2, 7), cyclic(True)]
    off = [switch(kit, LimitKind.SPEED, None), freeze(), cyclic(False)]
    for order in permutations(on):
        options = Options()
        for block in order:
            options = options.after(block, Q)
        assert set(options.limits) == set(LimitKind)
        assert options.frozen == (2, 7)
        np.testing.assert_array_equal(options.cyclic_posture, Q)
    for order in permutations(off):
        left = options
        for block in order:
            left = left.after(block, Q)
        assert set(left.limits) == {LimitKind.POSITION, LimitKind.ACCELERATION}
        assert left.frozen == ()
        assert left.frozen_by is None
        assert left.cyclic_posture is None


def test_a_switch_of_the_same_kind_replaces_the_one_before(kit) -> None:
    options = (
        Options().after(switch(kit, LimitKind.SPEED, 1.0), Q).after(switch(kit, LimitKind.SPEED, 2.0), Q)
    )
    found = limits_in_force(kit.limits(), options).limits
    assert found.speed_upper.tolist() == [2.0] * 7
    assert found.speed_lower.tolist() == [-2.0] * 7


def test_switching_off_what_is_not_on_changes_nothing(kit) -> None:
    options = (
        Options().after(switch(kit, LimitKind.SPEED, None), Q).after(freeze(), Q).after(cyclic(False), Q)
    )
    assert options == Options()


@pytest.mark.req("LANG-61")
def test_cyclic_posture_is_a_copy_of_the_moment() -> None:
    q = Q.copy()
    options = Options().after(cyclic(True), q)
    q[0] = 99.0
    np.testing.assert_array_equal(options.cyclic_posture, Q)
    np.testing.assert_array_equal(options.after(cyclic(True), Q + 1).cyclic_posture, Q + 1)


@pytest.mark.req("LANG-63")
def test_frozen_joints_count_from_one() -> None:
    free = Options().after(freeze(1, 7, 7), Q).free_joints(7)
    assert free.tolist() == [False, True, True, True, True, True, False]


@pytest.mark.parametrize("kind", LimitKind)
def test_limits_only_narrow(kit, kind: LimitKind) -> None:
    """Against the smaller of both, joint by joint and side by side."""
    rng = np.random.default_rng(3)
    robot = kit.limits(2.0, 3.0, 4.0)
    for _ in range(50):
        asked_lower, asked_upper = -rng.uniform(0.0, 6.0, 7), rng.uniform(0.0, 6.0, 7)
        asked_lower[rng.integers(7)] = -np.inf
        clause = LimitClause(kind, kit.range(asked_upper, asked_lower), THERE)
        found = limits_in_force(robot, Options(), [clause])
        own_lower, own_upper = robot.pair(kind.value.lower())
        lower, upper = found.limits.pair(kind.value.lower())
        for j in range(7):
            assert lower[j] == max(own_lower[j], asked_lower[j])
            assert upper[j] == min(own_upper[j], asked_upper[j])
        for other in set(LimitKind) - {kind}:
            assert found.limits.pair(other.value.lower()) == robot.pair(other.value.lower())
        assert found.asked_by == {kind: THERE}


@pytest.mark.parametrize("clause_half", [0.5, 1.5])
def test_a_clause_overrides_the_switch_of_its_kind_alone(kit, clause_half: float) -> None:
    options = Options()
    for kind in LimitKind:
        options = options.after(switch(kit, kind, 1.0), Q)
    clause = LimitClause(LimitKind.SPEED, kit.range(clause_half), THERE)
    found = limits_in_force(kit.limits(2.0, 3.0, 4.0), options, [clause])
    assert found.limits.speed_upper.tolist() == [clause_half] * 7
    assert found.limits.position_upper.tolist() == [1.0] * 7
    assert found.limits.acceleration_upper.tolist() == [1.0] * 7
    assert found.asked_by[LimitKind.SPEED] == THERE
    assert found.asked_by[LimitKind.POSITION] == HERE
