"""Least-norm problems with bounds on rows, against DAQP, the optimality conditions and linear programs."""

from __future__ import annotations

from time import perf_counter

import daqp
import numpy as np
import pytest
from scipy.optimize import linprog

from irlx.transform.qp.active_set import sharpen
from irlx.transform.qp.dual import DualSolver, _lost
from irlx.transform.qp.interval import IntervalSolver
from irlx.transform.qp.proxqp import ProxQpSolver
from long_run import first

pytestmark = pytest.mark.req("TRF-01")

KINDS = ["free", "few", "many", "degenerate", "duplicate", "zero rows", "tiny", "one sided"]
SLOW_CONTRADICTION = (52, 2)
"""ProxQP alone turns round here for two seconds."""
SOLVERS = [ProxQpSolver, DualSolver]


def random_problem(seed: int, r: int, kind: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rows and bounds of a problem that has a solution: an inner point is chosen first."""
    rng = np.random.default_rng([seed, r, KINDS.index(kind)])
    n = r + 6
    rows = rng.normal(size=(n, r))
    inner = rng.normal(size=r) * {"free": 0.0, "few": 0.3}.get(kind, 1.0)
    if kind == "duplicate":
        rows[1], rows[3] = rows[0], -rows[0]
    if kind == "zero rows":
        rows[[0, n - 1]] = 0.0
    reached = rows @ inner
    below, above = rng.uniform(0.01, 1.0, (2, n))
    if kind in ("degenerate", "duplicate"):
        # More rows than unknowns meet in the inner point.
        tight = rng.random(n) < 0.7
        below[tight] = above[tight] = 0.0
        above[rng.random(n) < 0.5] = 0.5
    lower, upper = reached - below, reached + above
    if kind == "one sided":
        lower[rng.random(n) < 0.5] = -np.inf
        upper[rng.random(n) < 0.5] = np.inf
    scale = 1e-7 if kind == "tiny" else 1.0
    return rows, lower * scale, upper * scale


def by_daqp(rows: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> np.ndarray | None:
    """DAQP's solution on the problem scaled to a violation of one, None where it finds it infeasible."""
    r = rows.shape[1]
    scale = max(float(np.max(lower)), float(np.max(-upper)), 0.0)
    if scale == 0.0:
        return np.zeros(r)
    low, up = np.maximum(lower / scale, -1e30), np.minimum(upper / scale, 1e30)
    sense = np.zeros(rows.shape[0], dtype=np.int32)
    options = {"primal_tol": 1e-11, "dual_tol": 1e-12}
    matrix = np.ascontiguousarray(rows)
    z, _, flag, _ = daqp.solve(np.eye(r), np.zeros(r), matrix, up, low, sense, **options)
    return scale * np.asarray(z) if flag >= 1 else None


def assert_optimal(rows, lower, upper, solution, where: str) -> None:
    """Feasible, and z is a combination of active rows that all push inwards (sufficient, as z is convex)."""
    z, active = solution.z, solution.active
    size = max(float(np.max(np.abs(z))), 1e-12)
    assert np.all(rows @ z <= upper + 1e-9 * max(1.0, size)), where
    assert np.all(rows @ z >= lower - 1e-9 * max(1.0, size)), where
    held = np.flatnonzero(active)
    multipliers, *_ = np.linalg.lstsq(rows[held].T, z, rcond=None)
    np.testing.assert_allclose(rows[held].T @ multipliers, z, atol=1e-9 * size, err_msg=where)
    bound = np.where(active > 0, upper, lower)[held]
    np.testing.assert_allclose(rows[held] @ z, bound, atol=1e-10 * max(1.0, size), err_msg=where)
    # A row without width may be named by either side.
    wide = (upper > lower)[held]
    if held.size and np.linalg.matrix_rank(rows[held]) == held.size:
        assert np.all((multipliers * active[held])[wide] <= 1e-8 * size), where


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("r", first(2, [2, 8, 3, 5]))
@pytest.mark.parametrize("make", SOLVERS)
def test_solution_equals_daqps(make, r: int, kind: str) -> None:
    """With the same solver for all problems of a size: none may depend on the ones before."""
    solver = make()
    for seed in [*range(20), 24, 56]:
        rows, lower, upper = random_problem(seed, r, kind)
        solution = solver.solve(rows, lower, upper)
        where = f"seed {seed}, r {r}, {kind}"
        assert solution.z is not None, where
        wanted = by_daqp(rows, lower, upper)
        assert wanted is not None, where
        size = max(float(np.max(np.abs(wanted))), 1e-30)
        # Where more rows meet than there are unknowns, DAQP's tolerance is seen at a sharper angle.
        accuracy = 1e-8 if kind in ("degenerate", "duplicate") else 1e-10
        np.testing.assert_allclose(solution.z, wanted, atol=accuracy * size, err_msg=where)
        assert_optimal(rows, lower, upper, solution, where)


@pytest.mark.parametrize("kind", KINDS)
def test_interval_equals_daqp(kind: str) -> None:
    for seed in range(60):
        rows, lower, upper = random_problem(seed, 1, kind)
        solution = IntervalSolver().solve(rows, lower, upper)
        where = f"seed {seed}, {kind}"
        assert solution.z is not None, where
        wanted = by_daqp(rows, lower, upper)
        assert solution.z == pytest.approx(wanted, abs=1e-9 * max(1e-7, abs(float(wanted[0])))), where
        assert_optimal(rows, lower, upper, solution, where)


def infeasible(seed: int, r: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Random rows, one combination of which would have to be two things at once."""
    rng = np.random.default_rng([seed, r])
    rows, lower, upper = random_problem(seed, r, "many")
    mix = rng.normal(size=r + 1)
    rows[-1] = mix @ rows[: r + 1]
    reach = np.sum(np.where(mix > 0, mix * upper[: r + 1], mix * lower[: r + 1]))
    lower[-1], upper[-1] = reach + rng.choice([1e-3, 0.1, 5.0]), np.inf
    return rows, lower, upper


@pytest.mark.parametrize(
    ("make", "r"), [(IntervalSolver, 1), *((make, r) for make in SOLVERS for r in (2, 5))]
)
def test_contradicting_rows_have_no_solution(make, r: int) -> None:
    solver = make()
    for seed in range(5):
        rows, lower, upper = infeasible(seed, r)
        finite = np.isfinite(upper)
        check = linprog(
            np.zeros(r),
            A_ub=np.vstack([rows[finite], -rows]),
            b_ub=np.concatenate([upper[finite], -lower]),
            bounds=(None, None),
        )
        assert check.status == 2, f"seed {seed}: the test's own problem has a solution"
        solution = solver.solve(rows, lower, upper)
        assert solution.z is None, f"seed {seed}, r {r}: {solution}"


def test_a_contradiction_is_found_in_a_fraction_of_a_second() -> None:
    problem = infeasible(*SLOW_CONTRADICTION)
    begin = perf_counter()
    assert ProxQpSolver().solve(*problem).z is None
    assert perf_counter() - begin < 0.3


@pytest.mark.parametrize(("make", "r"), [(IntervalSolver, 1), *((make, 3) for make in SOLVERS)])
def test_row_with_crossed_bounds_or_without_effect_has_no_solution(make, r: int) -> None:
    solver = make()
    rows, lower, upper = random_problem(1, r, "free")
    crossed = lower.copy()
    crossed[2] = upper[2] + 0.5
    assert solver.solve(rows, crossed, upper).z is None
    rows[2], lower[2], upper[2] = 0.0, 0.1, 0.2
    assert solver.solve(rows, lower, upper).z is None


def test_interval_clips_where_a_row_cuts() -> None:
    rows, infinite = np.array([[2.0], [-1.0], [0.0]]), np.full(3, np.inf)
    solution = IntervalSolver().solve(rows, np.array([1.0, -np.inf, -1.0]), infinite)
    assert solution.z.tolist() == [0.5]
    assert solution.active.tolist() == [-1, 0, 0]
    solution = IntervalSolver().solve(rows, -infinite, np.array([np.inf, -3.0, 0.0]))
    assert solution.z.tolist() == [3.0]
    assert solution.active.tolist() == [0, 1, 0]


@pytest.mark.parametrize("wrong", ["nothing", "all lower", "opposite", "random"])
def test_any_guess_of_the_active_set_leads_to_the_optimum(wrong: str) -> None:
    rng = np.random.default_rng(9)
    found = 0
    for seed in range(60):
        rows, lower, upper = random_problem(seed, 4, "few")
        wanted = by_daqp(rows, lower, upper)
        guess = np.zeros(10, dtype=np.int8)
        if wrong == "all lower":
            guess[:4] = -1
        elif wrong == "opposite":
            guess[np.flatnonzero(rows @ wanted >= upper - 1e-9)[:2]] = -1
        elif wrong == "random":
            guess[rng.choice(10, 3, replace=False)] = rng.choice([-1, 1], 3)
        solution = sharpen(rows, lower, upper, guess)
        if solution is not None:
            found += 1
            np.testing.assert_allclose(solution.z, wanted, atol=1e-9, err_msg=f"seed {seed}")
    assert found >= 54


def test_a_solver_used_before_gives_the_same_answer_again() -> None:
    """The workspace is kept between calls; what it solved before must not show in the bytes."""
    rows, lower, upper = random_problem(3, 5, "many")
    fresh = ProxQpSolver().solve(rows, lower, upper)
    used = ProxQpSolver()
    for seed in range(10, 20):
        used.solve(*random_problem(seed, 5, "degenerate"))
    again = used.solve(rows, lower, upper)
    np.testing.assert_array_equal(again.z, fresh.z)
    np.testing.assert_array_equal(again.active, fresh.active)


def test_whether_there_is_a_solution_does_not_depend_on_earlier_problems() -> None:
    problem = random_problem(6, 2, "many")
    assert ProxQpSolver().solve(*problem).z is not None
    used = ProxQpSolver()
    used.solve(*random_problem(1, 2, "few"))
    assert used.solve(*problem).z is not None


@pytest.mark.parametrize("kind", KINDS)
def test_a_guess_of_the_dual_solver_decides_nothing(kind: str) -> None:
    """Held rows that are right, that are not, that depend on each other, or more than there are unknowns."""
    rng = np.random.default_rng(KINDS.index(kind))
    for seed in range(12):
        r = 1 + seed % 5
        rows, lower, upper = random_problem(seed, r, kind)
        cold = DualSolver().solve(rows, lower, upper)
        assert cold.z is not None
        guesses = [cold.active, -cold.active, np.ones(len(rows), dtype=np.int8)]
        guesses += [rng.choice([-1, 0, 0, 1], len(rows)).astype(np.int8) for _ in range(4)]
        for guess in guesses:
            warm = DualSolver().solve(rows, lower, upper, guess)
            assert warm.z is not None, (seed, guess)
            size = max(
                float(np.max(np.abs(cold.z))),
                float(np.max(np.abs(upper - lower), initial=0.0, where=np.isfinite(upper - lower))),
            )
            apart = np.abs(warm.z - cold.z) - 1e-8 * max(size, 1e-12) - 1e-7 * np.abs(cold.z)
            assert np.max(apart) <= 0.0, f"{seed}, {guess}"
            assert_optimal(rows, lower, upper, warm, f"{kind} {seed} {guess}")


def test_a_guess_of_the_dual_solver_makes_nothing_possible() -> None:
    rows = np.array([[1.0, 0.0], [1.0, 1e-3], [0.0, 1.0]])
    lower, upper = np.array([1.0, -np.inf, -0.1]), np.array([np.inf, 0.5, 0.1])
    for guess in np.array([[0, 0, 0], [-1, 0, 0], [0, 1, 0], [-1, 1, 0], [-1, 1, 1]], dtype=np.int8):
        assert DualSolver().solve(rows, lower, upper, guess).z is None


def test_a_right_guess_saves_the_dual_solver_all_steps(monkeypatch) -> None:
    rows, lower, upper = random_problem(3, 5, "many")
    active = DualSolver().solve(rows, lower, upper).active
    assert np.count_nonzero(active) >= 2

    def never(*arguments: object) -> bool:
        raise AssertionError("a row was taken in")

    monkeypatch.setattr("irlx.transform.qp.dual._Iteration._take_in", never)
    np.testing.assert_array_equal(DualSolver().solve(rows, lower, upper, active).active, active)


@pytest.mark.parametrize(
    ("rows", "lost"),
    [
        ([[1.0, 0.0], [0.0, 1e-3]], False),
        ([[1.0, 0.0], [1.0, 1e-9]], True),
        ([[1.0, 2.0], [1.0, 2.0]], True),
        ([[0.3, 0.0]], False),
        ([[0.0, 0.0]], True),
    ],
)
def test_rows_that_depend_on_each_other_are_no_guess(rows, lost: bool) -> None:
    matrix = np.array(rows)
    assert _lost(matrix @ matrix.T, len(rows)) is lost


def test_rounding_is_judged_by_the_size_of_what_the_rows_reach() -> None:
    """Two rows of the same direction, one asks for 1E-10 more than the other, of a thousand: they agree."""
    rows, lower = np.array([[1.0, 0.0], [1.0, 0.0]]), np.array([1e3, 1e3 + 1e-10])
    found = sharpen(rows, lower, np.full(2, np.inf), np.array([-1, 0], dtype=np.int8))
    assert found is not None
    np.testing.assert_array_equal(found.z, [1e3, 0.0])


@pytest.mark.parametrize(("off", "solved"), [(0.0, True), (4e-12, True), (1e-10, False)])
def test_a_row_that_held_ones_decide_may_miss_by_rounding(off: float, solved: bool) -> None:
    """x >= 1, y >= 1 and x + y <= 2, but for what rounding left of it: they meet in one point, or nowhere."""
    rows = np.array([[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    lower, upper = np.array([1.0, 1.0, -np.inf]), np.array([np.inf, np.inf, 2.0 - off])
    found = DualSolver().solve(rows, lower, upper)
    assert (found.z is not None) is solved
    if solved:
        np.testing.assert_allclose(found.z, [1.0, 1.0], rtol=0, atol=1e-11)
