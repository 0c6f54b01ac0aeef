"""The part of a step that serves the criterion: how much of it is taken, the path always being met."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from irlx.transform.compact import Step, StepProblem
from irlx.transform.criterion_pace import CriterionPace, _along_path

pytestmark = pytest.mark.req("TRF-01")


def drawn(seed: int, n: int = 8, m: int = 3) -> tuple[StepProblem, Step]:
    """A problem with wide bounds, two joints held by them, and a step that meets its path."""
    rng = np.random.default_rng(seed)
    jacobian, hessian = rng.normal(size=(m, n)), rng.uniform(0.5, 3.0, n)
    d = rng.normal(size=n)
    active = np.zeros(n, dtype=np.int8)
    active[[1, 4]] = 1, -1
    wide = np.full(n, 50.0)
    return StepProblem(jacobian, jacobian @ d, rng.normal(size=n), hessian, -wide, wide), Step(d, active)


@pytest.mark.parametrize("seed", range(4))
def test_the_shortest_way_onto_the_path_leaves_held_joints_alone(seed: int) -> None:
    """Of the others the least-norm solution, in the units of H, of what the held ones leave."""
    problem, step = drawn(seed)
    found = _along_path(problem, step)
    held = step.active != 0
    np.testing.assert_array_equal(found[held], step.d[held])
    np.testing.assert_allclose(problem.jacobian @ found, problem.twist, rtol=0, atol=1e-12)
    root = np.sqrt(problem.hessian[~held])
    left = problem.twist - problem.jacobian[:, held] @ step.d[held]
    shortest = np.linalg.lstsq(problem.jacobian[:, ~held] / root, left, rcond=None)[0] / root
    np.testing.assert_allclose(found[~held], shortest, rtol=0, atol=1e-12)


def test_without_held_joints_it_is_the_shortest_of_all() -> None:
    problem, step = drawn(9)
    found = _along_path(problem, Step(step.d, np.zeros(8, dtype=np.int8)))
    root = np.sqrt(problem.hessian)
    shortest = np.linalg.lstsq(problem.jacobian / root, problem.twist, rcond=None)[0] / root
    np.testing.assert_allclose(found, shortest, rtol=0, atol=1e-12)


def test_too_few_joints_that_are_not_held_have_no_way() -> None:
    problem, step = drawn(9)
    active = np.ones(8, dtype=np.int8)
    active[:2] = 0
    assert _along_path(problem, Step(step.d, active)) is None


def bent(factor: float) -> tuple[np.ndarray, np.ndarray, CriterionPace]:
    """A step s, the one of `factor` s that is asked for after it, and what has seen the first."""
    pace, first = CriterionPace(), np.array([0.2, -0.1, 0.4])
    pace.took(np.zeros(3), first, first)
    return first, factor * first, pace


@pytest.mark.parametrize(
    ("factor", "share"),
    [(0.5, 2.0), (-0.5, 1.0 / 1.5), (-1.0, 0.5), (0.0, 1.0), (0.9, 2.0), (-99.0, 0.05), (2.0, 1.0)],
)
def test_the_share_is_that_of_a_secant(factor: float, share: float) -> None:
    """Along one way the wanted step falls from s to f s: it is nothing after s / (1 - f)."""
    _, following, pace = bent(factor)
    assert pace.share(np.zeros(3), np.array([1.0, 2.0, 3.0]), following) == pytest.approx(share)


def test_away_from_the_path_the_whole_step_is_taken() -> None:
    _, following, pace = bent(-1.0)
    assert pace.share(np.array([0.0, 2e-3, 0.0]), np.ones(3), following) == 1.0
    assert pace.share(np.array([0.0, 0.9e-3, 0.0]), np.ones(3), following) == pytest.approx(0.5)


def test_a_step_that_is_shaped_still_meets_the_path() -> None:
    """Half of a step in the null space that would undo the one before."""
    problem, step = drawn(3)
    near = replace(problem, twist=np.zeros(3))
    basis = np.linalg.svd(problem.jacobian)[2][3:].T
    d = basis @ (basis.T @ step.d)
    pace = CriterionPace()
    pace.took(np.zeros(3), d, d)
    taken = pace.shape(near, Step(-d, np.zeros(8, dtype=np.int8)))
    np.testing.assert_allclose(taken, -0.5 * d, rtol=0, atol=1e-12)
