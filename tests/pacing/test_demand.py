"""Demands as arrays are the demands one by one."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.pacing.clock import Clock
from irlx.pacing.demand import Demand, Demands, demands
from machines import machine

S = np.array([0.0, 0.01, 0.05, 0.2])


def drawn(modifiers=(), ticks_a_row: float = 1.0) -> Demands:
    path = machine("arm7").line((0.0, -0.3, 0.0), (0.1, 0.0, 0.0))
    return demands(path, Clock(S, 2.0 * S, ticks_a_row), 8, modifiers)


def test_each_demand_is_that_of_its_place() -> None:
    path, found = machine("arm7").line((0.0, -0.3, 0.0), (0.1, 0.0, 0.0)), drawn()
    assert [one.tick for one in found] == [8, 9, 10, 11]
    assert [found[k].s for k in range(4)] == S.tolist()
    for k, one in enumerate(found):
        pose = path.poses(S[k : k + 1])
        assert np.all(one.position == pose.position[0])
        assert np.all(one.rotation == pose.rotation[0])
        # Central differences of the path say what a second of its parameter moves.
        ahead, back = path.poses(S[k : k + 1] + 1e-6), path.poses(S[k : k + 1] - 1e-6)
        speed = (ahead.position[0] - back.position[0]) / 2e-6 * 2.0 * S[k]
        np.testing.assert_allclose(one.twist[:3], speed, atol=1e-8)
    assert isinstance(found[-1], Demand)
    assert found[-1].tick == 11


def test_rows_of_several_ticks_end_at_whole_ones() -> None:
    assert drawn(ticks_a_row=2.5).tick.tolist() == [7 + round(2.5 * k) for k in (1, 2, 3, 4)]


def test_modifiers_act_one_behind_the_other_on_each() -> None:
    def raised(demand: Demand) -> Demand:
        return demand._replace(position=demand.position + np.array([0.0, 0.0, 1.0]))

    def doubled(demand: Demand) -> Demand:
        return demand._replace(position=2.0 * demand.position)

    np.testing.assert_array_equal(
        drawn((raised, doubled)).position, 2.0 * (drawn().position + np.array([0.0, 0.0, 1.0]))
    )


def test_parts_and_joints_keep_every_column() -> None:
    found = drawn()
    again = Demands.joined(found[:1], found[1:3], found[3:])
    for name in ("tick", "s", "position", "rotation", "twist"):
        np.testing.assert_array_equal(getattr(again, name), getattr(found, name))
        np.testing.assert_array_equal(getattr(Demands.of(list(found)), name), getattr(found, name))
    assert found.later(5).tick.tolist() == [13, 14, 15, 16]
    assert found.repeated(-1, 2).tick.tolist() == [11, 11]
    assert found.repeated(0, 0).s.tolist() == []
    nothing = Demands.of([])
    assert len(nothing) == 0
    np.testing.assert_array_equal(Demands.joined(nothing, found).twist, found.twist)
    with pytest.raises(IndexError):
        found[4]
