"""The step of a nearly singular Jacobian, against elimination in rational numbers."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from irlx.transform.compact import StepProblem, bounded_step, free_step, null_space_rows, path_step
from irlx.transform.orthogonal import Factors, unrounded_residual
from irlx.transform.qp.proxqp import ProxQpSolver
from long_run import chequered

pytestmark = pytest.mark.req("TRF-01")

SINES = [1e-3, 1e-5, 1e-7, 1e-9]


def exactly_solved(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solution of a regular system by Gauss' elimination of the very floats."""
    table = [
        [Fraction(v) for v in [*row, value]]
        for row, value in zip(matrix.tolist(), right.tolist(), strict=True)
    ]
    for k in range(len(table)):
        pivot = next(i for i in range(k, len(table)) if table[i][k])
        table[k], table[pivot] = table[pivot], table[k]
        table[k] = [value / table[k][k] for value in table[k]]
        for i, row in enumerate(table):
            if i != k and row[k]:
                table[i] = [a - row[k] * b for a, b in zip(row, table[k], strict=True)]
    return np.array([float(row[-1]) for row in table])


def nearly_singular(seed: int, n: int, m: int, sine: float, full: bool) -> StepProblem:
    """A J whose last row is a combination of the others but for `sine`, its rows in units of 1e-3 to 1e3."""
    rng = np.random.default_rng([seed, n, m, full])
    rows = rng.normal(size=(m, n))
    rows[-1] = rng.normal(size=m - 1) @ rows[:-1] + sine * rows[-1]
    rows = 10.0 ** rng.uniform(-3.0, 3.0, (m, 1)) * rows
    hessian = rng.uniform(0.1, 10.0, n)
    if full:
        half = rng.normal(size=(n, n))
        hessian = half @ half.T + np.diag(hessian)
    d = 0.1 * rng.normal(size=n)
    return without_bounds(rows, rows @ d, rng.normal(size=n), hessian)


def without_bounds(
    rows: np.ndarray, twist: np.ndarray, gradient: np.ndarray, hessian: np.ndarray
) -> StepProblem:
    wide = np.full(gradient.size, np.inf)
    return StepProblem(rows, twist, gradient, hessian, -wide, wide)


def whole_system(problem: StepProblem) -> np.ndarray:
    m = len(problem.jacobian)
    hessian = problem.hessian if problem.hessian.ndim == 2 else np.diag(problem.hessian)
    return np.block([[hessian, -problem.jacobian.T], [problem.jacobian, np.zeros((m, m))]])


@pytest.mark.parametrize(
    ("full", "sine"), chequered([pytest.param(False, id="diagonal"), pytest.param(True, id="full")], SINES)
)
def test_free_and_path_step_are_right_to_their_last_digits(sine: float, full: bool) -> None:
    for seed in (0, 2, 4, 7):
        n = 4 + seed
        problem = nearly_singular(seed, n, min(2 + seed, 7), sine, full)
        for step, gradient in (
            (free_step, problem.gradient),
            (path_step, np.zeros(n)),
        ):
            wanted = exactly_solved(whole_system(problem), np.concatenate([-gradient, problem.twist]))[:n]
            size = max(1.0, float(np.max(np.abs(wanted))))
            # Above a sine of 1e-4 the Gram matrix stays; its loss is the square of its condition.
            lost = 1e-8 if sine > 1e-4 and step is path_step else 1e-12
            np.testing.assert_allclose(step(problem), wanted, rtol=0, atol=lost * size, err_msg=f"{seed}")


def test_as_many_rows_as_joints_have_one_step() -> None:
    problem = nearly_singular(2, 6, 6, 1e-6, True)
    whole = whole_system(problem)
    for step, gradient in ((free_step, problem.gradient), (path_step, np.zeros(6))):
        wanted = exactly_solved(whole, np.concatenate([-gradient, problem.twist]))[:6]
        size = max(1.0, float(np.max(np.abs(wanted))))
        np.testing.assert_allclose(step(problem), wanted, rtol=0, atol=1e-12 * size)


@pytest.mark.parametrize("full", [False, True], ids=["diagonal", "full"])
@pytest.mark.parametrize("sine", SINES)
def test_null_space_is_orthonormal_and_has_no_part_along_the_path(sine: float, full: bool) -> None:
    for seed in range(8):
        problem = nearly_singular(seed, 7 + seed, 3 + seed // 2, sine, full)
        rows = null_space_rows(problem)
        n, m = problem.gradient.size, len(problem.jacobian)
        hessian = whole_system(problem)[:n, :n]
        assert rows.shape == (n, n - m)
        np.testing.assert_allclose(rows.T @ hessian @ rows, np.eye(n - m), atol=1e-11)
        off = np.array([unrounded_residual(problem.jacobian, column, np.zeros(m)) for column in rows.T]).T
        # What is off the path, as the shortest step that would undo it: rounding of the entries of N.
        back = path_step(without_bounds(problem.jacobian, off[:, 0], np.zeros(n), problem.hessian))
        assert np.max(np.abs(back)) < (1e-12 if sine > 1e-4 else 1e-14)


@pytest.mark.parametrize("full", [False, True], ids=["diagonal", "full"])
def test_rank_lost_to_rounding_is_reported_but_leaves_a_null_space(full: bool) -> None:
    problem = nearly_singular(3, 9, 5, 0.0, full)
    for step in (free_step, path_step):
        with pytest.raises(np.linalg.LinAlgError):
            step(problem)
    rows = null_space_rows(problem)
    assert rows.shape == (9, 4)
    np.testing.assert_allclose(problem.jacobian @ rows, 0.0, atol=1e-12 * np.max(np.abs(problem.jacobian)))


def test_a_row_of_zeros_leaves_a_null_space() -> None:
    problem = nearly_singular(3, 9, 5, 0.1, False)
    problem.jacobian[2] = 0.0
    rows = null_space_rows(problem)
    assert rows.shape == (9, 4)
    np.testing.assert_allclose(problem.jacobian @ rows, 0.0, atol=1e-12 * np.max(np.abs(problem.jacobian)))


def test_more_rows_than_joints_and_what_is_no_number_are_lost_rank() -> None:
    problem = nearly_singular(0, 4, 3, 1e-3, False)
    for rows in (np.vstack([problem.jacobian, np.ones((2, 4))]), np.full((3, 4), np.nan)):
        with pytest.raises(np.linalg.LinAlgError):
            free_step(without_bounds(rows, np.ones(len(rows)), problem.gradient, problem.hessian))


def test_a_bounded_step_near_a_singular_posture_is_the_optimum_of_the_joints_it_leaves_free() -> None:
    """With its held joint known, the rest is again a system without bounds."""
    held = 0
    for seed in range(40):
        problem = nearly_singular(seed, 9, 4, 1e-7, False)
        d_free = free_step(problem)
        joint, moving = seed % 9, np.arange(9) != seed % 9
        room = np.where(moving, np.inf, 0.5 * np.abs(d_free))
        step = bounded_step(replace(problem, lower=-room, upper=room), d_free, ProxQpSolver())
        if step is None:
            continue
        held += 1
        assert abs(step.d[joint]) == room[joint]
        twist = unrounded_residual(problem.jacobian[:, ~moving], step.d[~moving], problem.twist)
        rest = without_bounds(
            problem.jacobian[:, moving], twist, problem.gradient[moving], problem.hessian[moving]
        )
        wanted = exactly_solved(whole_system(rest), np.concatenate([-rest.gradient, twist]))[:8]
        np.testing.assert_allclose(step.d[moving], wanted, rtol=0, atol=1e-9, err_msg=f"{seed}")
    assert held > 30


def test_the_residual_rounds_once() -> None:
    rng = np.random.default_rng(4)
    for _ in range(20):
        matrix = rng.normal(size=(3, 8)) * 10.0 ** rng.uniform(-12.0, 12.0, (3, 8))
        x = rng.normal(size=8)
        right = matrix @ x
        exact = [
            Fraction(b) - sum(Fraction(a) * Fraction(c) for a, c in zip(row, x.tolist(), strict=True))
            for row, b in zip(matrix.tolist(), right.tolist(), strict=True)
        ]
        assert unrounded_residual(matrix, x, right).tolist() == [float(value) for value in exact]


@pytest.mark.parametrize(("n", "m"), [(7, 6), (6, 6), (11, 6), (3, 1), (20, 9)])
def test_factors_are_orthonormal_and_give_the_rows_back(n: int, m: int) -> None:
    """Q1 R = (J L^-T)', Q'Q = 1, by plain products; numpy's own factors are the same but for signs."""
    rng = np.random.default_rng([n, m])
    jacobian, weights = rng.normal(size=(m, n)), rng.uniform(0.1, 10.0, n)
    factors = Factors.of(jacobian, weights)
    columns = (jacobian / np.sqrt(weights)).T
    upper = np.triu(factors.triangle)
    np.testing.assert_allclose(factors.along @ upper, columns, atol=1e-13)
    whole = np.hstack([factors.along, factors.aside])
    np.testing.assert_allclose(whole.T @ whole, np.eye(n), atol=1e-14)
    np.testing.assert_allclose(np.abs(np.linalg.qr(columns)[1]), np.abs(upper), atol=1e-12)
