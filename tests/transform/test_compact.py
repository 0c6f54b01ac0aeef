"""The compact step against the full problem with its equality rows written out (TRF-01)."""

from __future__ import annotations

import daqp
import numpy as np
import pytest
from scipy.optimize import linprog

from irlx.transform.compact import (
    bounded_step,
    free_step,
    nearly_singular,
    null_space_rows,
    path_step,
    within,
)
from irlx.transform.orthogonal import FLAT
from irlx.transform.qp.proxqp import ProxQpSolver
from long_run import first

pytestmark = pytest.mark.req("TRF-01")

SIZES = range(6, 13)


def full_qp(problem) -> np.ndarray | None:
    """DAQP on min g'd + 1/2 d'Hd, Jd = e, lower <= d <= upper, all rows written out, in units of H^1/2."""
    m, n = problem.jacobian.shape
    root = np.sqrt(problem.hessian)
    size = max(float(np.max(np.abs(problem.gradient / root))), float(np.max(np.abs(problem.twist))), 1e-6)
    rows = np.vstack([np.diag(1.0 / root), problem.jacobian / root])
    low = np.concatenate([problem.lower, problem.twist]) / size
    up = np.concatenate([problem.upper, problem.twist]) / size
    sense = np.concatenate([np.zeros(n), np.full(m, 5)]).astype(np.int32)
    options = {"primal_tol": 1e-12, "dual_tol": 1e-12, "iter_limit": 2000}
    g = problem.gradient / root / size
    x, _, flag, _ = daqp.solve(np.eye(n), g, np.ascontiguousarray(rows), up, low, sense, **options)
    return size * np.asarray(x) / root if flag >= 1 else None


def compact(problem) -> np.ndarray | None:
    d_free = free_step(problem)
    if within(d_free, problem.lower, problem.upper):
        return d_free
    step = bounded_step(problem, d_free, ProxQpSolver())
    return None if step is None else step.d


def margin(problem) -> float:
    """How far some step stays inside all bounds at best (negative: none exists), by a linear program."""
    n = problem.hessian.size
    ones = np.ones((n, 1))
    found = linprog(
        np.concatenate([np.zeros(n), [-1.0]]),
        A_ub=np.block([[np.eye(n), ones], [-np.eye(n), ones]]),
        b_ub=np.concatenate([problem.upper, -problem.lower]),
        A_eq=np.hstack([problem.jacobian, np.zeros((6, 1))]),
        b_eq=problem.twist,
        bounds=[(None, None)] * n + [(-1.0, 1.0)],
    )
    return float(found.x[-1]) if found.status == 0 else -np.inf


@pytest.mark.parametrize("n", first(4, sorted(SIZES, key=lambda n: n % 3)))
def test_compact_and_full_problem_give_the_same_step(making, n: int) -> None:
    compared = bounded = 0
    for seed in range(200):
        problem = making.random_step_problem(seed, n)
        found, wanted = compact(problem), full_qp(problem)
        if found is None or wanted is None:
            # The two may differ on the brink alone: no step, or one without room.
            assert (found is None and wanted is None) or abs(margin(problem)) < 1e-8, f"seed {seed}, n {n}"
            continue
        rows = null_space_rows(problem)
        condition = np.linalg.cond(rows) ** 2 if rows.size else 1.0
        # Where more joints meet bounds than there are unknowns, the QP solver's own accuracy stays.
        on_bound = (wanted - problem.lower < 1e-9) | (problem.upper - wanted < 1e-9)
        accuracy = 1e-8 if np.count_nonzero(on_bound) > n - 6 else 1e-9
        tolerance = accuracy * max(1.0, condition / 1e6) * max(1.0, float(np.max(np.abs(wanted))))
        apart = np.abs(found - wanted) - tolerance - 1e-7 * np.abs(wanted)
        assert np.max(apart) <= 0.0, f"seed {seed}, n {n}"
        outside = np.maximum(found - problem.upper, problem.lower - found)
        assert np.max(outside) < max(1e-12, tolerance if accuracy > 1e-9 else 0.0), f"seed {seed}, n {n}"
        compared += 1
        bounded += not within(free_step(problem), problem.lower, problem.upper)
    assert compared > (20 if n == 6 else 100), "the test compares too little"
    assert n <= 6 or bounded > 50, "bounds bind too rarely"


@pytest.mark.parametrize("n", SIZES)
def test_free_step_solves_the_optimality_equations(making, n: int) -> None:
    """Against the whole linear system of Lagrange: H d - J'k = -g, J d = e."""
    for seed in range(50):
        problem = making.random_step_problem(seed, n)
        matrix = np.block(
            [[np.diag(problem.hessian), -problem.jacobian.T], [problem.jacobian, np.zeros((6, 6))]]
        )
        wanted = np.linalg.solve(matrix, np.concatenate([-problem.gradient, problem.twist]))[:n]
        scale = max(1.0, float(np.max(np.abs(wanted))), np.linalg.cond(matrix) * 1e-4)
        np.testing.assert_allclose(free_step(problem), wanted, atol=1e-11 * scale, err_msg=f"seed {seed}")


@pytest.mark.parametrize("n", SIZES)
def test_path_step_is_the_weighted_pseudo_inverse(making, n: int) -> None:
    for seed in range(30):
        problem = making.random_step_problem(seed, n)
        root = np.sqrt(problem.hessian)
        wanted = np.linalg.pinv(problem.jacobian / root) @ problem.twist / root
        scale = max(1.0, float(np.max(np.abs(wanted)))) * np.linalg.cond(problem.jacobian) ** 2
        np.testing.assert_allclose(path_step(problem), wanted, atol=1e-13 * scale, err_msg=f"seed {seed}")


@pytest.mark.parametrize("n", SIZES)
def test_null_space_rows_are_orthonormal_under_the_hessian(making, n: int) -> None:
    for seed in range(20):
        problem = making.random_step_problem(seed, n)
        rows = null_space_rows(problem)
        assert rows.shape == (n, n - 6)
        np.testing.assert_allclose(problem.jacobian @ rows, 0.0, atol=1e-13 * n)
        np.testing.assert_allclose((rows.T * problem.hessian) @ rows, np.eye(n - 6), atol=1e-12)


def test_bounded_step_holds_active_joints_on_their_bound_to_the_last_bit(making) -> None:
    held = 0
    for seed in range(100):
        problem = making.random_step_problem(seed, 9)
        d_free = free_step(problem)
        step = bounded_step(problem, d_free, ProxQpSolver())
        if step is None:
            continue
        np.testing.assert_array_equal(step.d[step.active > 0], problem.upper[step.active > 0])
        np.testing.assert_array_equal(step.d[step.active < 0], problem.lower[step.active < 0])
        held += int(np.count_nonzero(step.active))
    assert held > 50


def test_lost_rank_is_reported(making) -> None:
    problem = making.random_step_problem(0, 8)
    problem.jacobian[3] = 0.0
    with pytest.raises(np.linalg.LinAlgError):
        free_step(problem)


@pytest.mark.parametrize(("share", "flat"), [(0.5, True), (0.99, True), (1.01, False), (40.0, False)])
@pytest.mark.parametrize("unit", [1.0, 1e-4])
def test_a_row_is_nearly_a_combination_of_others_by_the_angle_to_them(
    share: float, flat: bool, unit: float
) -> None:
    """The sine of the angle against FLAT, in whatever unit the row is."""
    angle = np.arcsin(share * FLAT)
    rows = np.array([[1.0, 0.0], [unit * np.cos(angle), unit * np.sin(angle)]])
    gram = rows @ rows.T
    assert nearly_singular(gram, np.linalg.cholesky(gram)) is flat


def test_on_a_bound_is_within_it() -> None:
    low, up = np.array([-1.0, 0.0]), np.array([2.0, 0.0])
    assert within(low, low, up)
    assert within(up, low, up)
    assert not within(np.nextafter(low, -9.0), low, up)
    assert not within(np.nextafter(up, 9.0), low, up)
