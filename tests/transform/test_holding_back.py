"""How ticks begin behind those that had to hold their criterion back."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from flat_criterion import Flat
from irlx.transform.holding_back import LONGEST_WAIT, HoldingBack
from irlx.transform.precision import RESTRAINTS
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.tick import TickSolver
from irlx.transform.tick_problem import TickProblem


def begins(holding_back: HoldingBack, ticks: int) -> list[float | None]:
    return [holding_back.begin() for _ in range(ticks)]


def test_ticks_behind_one_that_needed_it_begin_so_and_more_of_them_each_time() -> None:
    holding_back = HoldingBack()
    assert begins(holding_back, 3) == [None] * 3
    waits = []
    holding_back.needed(0.1)
    for _ in range(9):
        waits.append(0)
        while holding_back.begin() == 0.1:
            waits[-1] += 1
        # The tick that began without needs it again.
        holding_back.needed(0.1)
    assert waits == [1, 2, 4, 8, 16, 32, 64, LONGEST_WAIT, LONGEST_WAIT]


def test_behind_the_first_tick_of_a_walk_one_tick_begins_so() -> None:
    holding_back = HoldingBack()
    assert holding_back.begin() is None
    holding_back.needed(0.01)
    assert begins(holding_back, 2) == [0.01, None]


def test_a_tick_that_settles_without_makes_the_wait_short_again() -> None:
    holding_back = HoldingBack()
    for _ in range(3):
        holding_back.begin()
        holding_back.needed(1.0)
        while holding_back.begin() is not None:
            pass
    assert begins(holding_back, 5) == [None] * 5
    holding_back.needed(10.0)
    assert begins(holding_back, 3) == [10.0, None, None]


def test_a_restraint_that_serves_no_longer_is_not_tried_again() -> None:
    holding_back = HoldingBack()
    for _ in range(3):
        holding_back.begin()
        holding_back.needed(0.01)
    assert holding_back.begin() == 0.01
    holding_back.failed()
    assert begins(holding_back, 2) == [None, None]


class Counting(TickSolver):
    """Counts how often Newton's steps are begun."""

    begun = 0

    def _newton(self, problem, whole):
        Counting.begun += 1
        return super()._newton(problem, whole)


def test_ticks_in_a_row_that_do_not_settle_look_for_their_restraint_once(koch11) -> None:
    """The second such tick costs one search, the first all those that fail before; both keep their path."""
    solver = Counting(koch11.kinematics, ProxQpSolver())
    for seed in range(30):
        rng = np.random.default_rng(seed)
        criterion = Flat(rng.normal(size=(6, 11)))
        rotation, position = koch11.kinematics.tool_pose(koch11.q)
        turn = Rotation.from_rotvec(0.02 * rng.uniform(-1, 1, 3)).as_matrix()
        target = koch11.kinematics.target(rotation @ turn, position + 0.02 * rng.uniform(-1, 1, 3))
        problem = TickProblem(target, koch11.q, koch11.bounds(np.inf), criterion, np.ones(11, dtype=bool))
        if solver.solve(problem).solved:
            continue
        walking, costs, found = solver.restraining(), [], []
        for _ in range(2):
            Counting.begun = 0
            found.append(walking.solve(problem))
            costs.append(Counting.begun)
        assert costs[0] >= 3
        assert costs[1] == 1
        assert found[0].solved
        assert found[1].solved
        np.testing.assert_allclose(found[1].q, found[0].q, rtol=0.0, atol=1e-6)
        return
    raise AssertionError(f"no tick of these seeds needs any of {RESTRAINTS}")
