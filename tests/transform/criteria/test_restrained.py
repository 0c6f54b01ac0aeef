"""A criterion that is held back: what it is, and ticks that need it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import approx_fprime
from scipy.spatial.transform import Rotation

from flat_criterion import Flat
from irlx.transform.criteria.criterion import Criterion
from irlx.transform.criteria.posture import Posture
from irlx.transform.criteria.restrained import HeldBack, Restrained
from irlx.transform.metric import times
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.tick import TickSolver
from irlx.transform.tick_problem import TickProblem


def base(kind: str, rng: np.random.Generator) -> Criterion:
    if kind == "whole":
        return Flat(rng.normal(size=(3, 5)))
    return Posture(rng.uniform(1.0, 3.0, 5), rng.normal(size=5))


@pytest.mark.parametrize("kind", ["whole", "diagonal"])
def test_derivatives(kind: str) -> None:
    for seed in range(5):
        rng = np.random.default_rng(seed)
        criterion = base(kind, rng)
        held = Restrained(criterion, 0.5)
        q, step = rng.normal(size=5), rng.normal(size=5)
        slope = approx_fprime(step, lambda x, held=held, q=q: held.value(q, x), 1e-7)
        np.testing.assert_allclose(held.gradient(q, step), slope, rtol=1e-5, atol=1e-5)
        hessian = held.hessian() if kind == "whole" else np.diag(held.hessian())
        bend = approx_fprime(step, lambda x, held=held, q=q: held.gradient(q, x), 1e-7)
        np.testing.assert_allclose(hessian, bend, rtol=1e-5, atol=1e-5)
        undone = times(held.inverse_hessian(), times(held.hessian(), step))
        np.testing.assert_allclose(undone, step, rtol=0.0, atol=1e-9)
        # What is held back is taken from nothing: without a step both agree, and the criterion is unchanged.
        assert held.value(q, np.zeros(5)) == criterion.value(q, np.zeros(5))
        np.testing.assert_array_equal(held.gradient(q, np.zeros(5)), criterion.gradient(q, np.zeros(5)))


@pytest.mark.parametrize("kind", ["whole", "diagonal"])
def test_held_back_a_criterion_is_restrained_once_its_tick_has_begun(kind: str) -> None:
    rng = np.random.default_rng(5)
    criterion, q, step = base(kind, rng), rng.normal(size=5), rng.normal(size=5)
    held, known = HeldBack(Whole(criterion), 0.25), Restrained(criterion, 0.25)
    assert held.name == known.name == criterion.name
    assert held.value(q, step) == known.value(q, step)
    np.testing.assert_array_equal(held.gradient(q, step), known.gradient(q, step))
    np.testing.assert_array_equal(held.begun(q).hessian(), known.hessian())
    np.testing.assert_array_equal(held.begun(q).pull(q, step), known.pull(q, step))
    with pytest.raises(TypeError):
        held.hessian()


def test_what_asks_for_less_is_held_back_all_the_same() -> None:
    """What a criterion adds is cut off by plans before the restraint is added, which never asks for more."""
    rng = np.random.default_rng(6)
    criterion, q, step = Flat(rng.normal(size=(3, 5))), rng.normal(size=5), rng.normal(size=5)
    less = Restrained(Asking(criterion, 4.0), 0.5).asking_at_most(1.0)
    np.testing.assert_allclose(
        less.gradient(q, step), Restrained(criterion, 0.5).gradient(q, step), rtol=1e-12
    )
    held = Restrained(criterion, 0.5)
    assert held.asking_at_most(1.0) is held


class Whole(Criterion):
    """A criterion that is known once its tick has begun."""

    def __init__(self, criterion: Criterion) -> None:
        self._criterion, self.name = criterion, criterion.name

    def begun(self, q: np.ndarray) -> Criterion:
        return self._criterion

    def value(self, q: np.ndarray, step: np.ndarray) -> float:
        raise AssertionError("not begun")

    gradient = value

    def hessian(self) -> np.ndarray:
        raise AssertionError("not begun")


class Asking(Flat):
    """A criterion that asks for a multiple of another's, unless it is told to ask for less."""

    def __init__(self, criterion: Criterion, times: float) -> None:
        self._less, self._hessian = criterion, times * criterion.hessian()

    def asking_at_most(self, size: float) -> Criterion:
        return self._less


@pytest.mark.req("TRF-05")
def test_no_criterion_takes_a_tick_off_its_path(koch11) -> None:
    """Directions in which a criterion hardly grows let Newton's steps go to and fro; the path is kept."""
    solver, unsettled = TickSolver(koch11.kinematics, ProxQpSolver()), 0
    for seed in range(30):
        rng = np.random.default_rng(seed)
        criterion = Flat(rng.normal(size=(6, 11)))
        rotation, position = koch11.kinematics.tool_pose(koch11.q)
        turn = Rotation.from_rotvec(0.02 * rng.uniform(-1, 1, 3))
        position = position + 0.02 * rng.uniform(-1, 1, 3)
        target = koch11.kinematics.target(rotation @ turn.as_matrix(), position)
        bounds = koch11.bounds(np.inf)
        problem = TickProblem(target, koch11.q, bounds, criterion, np.ones(11, dtype=bool))
        unsettled += not solver.solve(problem).solved
        solution = solver.restraining().solve(problem)
        assert solution.solved, f"seed {seed}"
        reached, there = koch11.kinematics.tool_pose(solution.q)
        np.testing.assert_allclose(there, position, rtol=0.0, atol=1e-8)
        np.testing.assert_allclose(reached, target.rotation, rtol=0.0, atol=1e-8)
        step = solution.q - koch11.q
        assert np.all((bounds.lower <= step) & (step <= bounds.upper))
    # One of them at least is of the kind that this is for; where it is not, nothing changes.
    assert 0 < unsettled < 5
