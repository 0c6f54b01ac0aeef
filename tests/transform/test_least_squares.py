"""Least squares within bounds, beside SciPy's and closed forms."""

import numpy as np
import pytest
from scipy.optimize import least_squares, lsq_linear

from irlx.transform.least_squares import (
    _Search,
    _step,
    _steps,
    least_squares_from,
    least_squares_in_bounds,
)
from long_run import first


def cost(residual, x):
    return float(np.sum(residual(x)[0] ** 2))


def linear(matrix, aim):
    return lambda x: (matrix @ x - aim, matrix)


@pytest.mark.req("QA-04")
@pytest.mark.parametrize("seed", first(20, range(60)))
def test_linear_rows_as_scipy_finds_them(seed):
    random = np.random.default_rng(seed)
    rows, columns = int(random.integers(1, 7)), int(random.integers(1, 12))
    matrix, aim = random.normal(size=(rows, columns)), 3.0 * random.normal(size=rows)
    # Zeros, equal columns and residues of roundings are what robots stretched out have.
    matrix[:, random.random(columns) < 0.2] = 0.0
    matrix[:, 0] = matrix[:, -1] * random.choice([1.0, 1.0 + 1e-16, -1.0])
    lower = np.where(random.random(columns) < 0.3, -np.inf, -random.random(columns))
    upper = np.where(random.random(columns) < 0.3, np.inf, random.random(columns) + 1e-3)
    start = random.choice([0.0, -1e-16, 1.0], size=columns).clip(lower, upper)
    found = least_squares_in_bounds(linear(matrix, aim), start, lower, upper)
    assert np.all((lower <= found) & (found <= upper))
    best = lsq_linear(matrix, aim, (lower, upper), tol=1e-14)
    assert cost(linear(matrix, aim), found) <= 2.0 * best.cost * (1.0 + 1e-6) + 1e-18


def two_links(aim):
    def residual(q):
        a, b = q[0], q[0] + q[1]
        place = np.array([np.cos(a) + np.cos(b), np.sin(a) + np.sin(b)])
        return place - aim, np.array(
            [[-np.sin(a) - np.sin(b), -np.sin(b)], [np.cos(a) + np.cos(b), np.cos(b)]]
        )

    return residual


@pytest.mark.parametrize("seed", first(15, range(40)))
def test_two_links_by_their_closed_form(seed):
    random = np.random.default_rng(seed)
    distance, turn = random.uniform(0.2, 3.0), random.uniform(-3.0, 3.0)
    aim = distance * np.array([np.cos(turn), np.sin(turn)])
    start = np.array([turn + random.uniform(-1.0, 1.0), random.uniform(0.1, 2.0)])
    wide = np.full(2, 9.0)
    found = least_squares_in_bounds(two_links(aim), start, -wide, wide)
    # Beyond the stretched arm what is missing is the way from its end.
    assert np.sqrt(cost(two_links(aim), found)) == pytest.approx(max(distance - 2.0, 0.0), abs=1e-9)


@pytest.mark.parametrize("seed", first(15, range(40)))
def test_narrow_bounds_as_scipy_finds_them_or_better(seed):
    random = np.random.default_rng(100 + seed)
    aim, start = random.uniform(-1.5, 1.5, 2), random.uniform(-0.5, 0.5, 2)
    lower, upper = start - random.random(2), start + random.random(2)
    residual = two_links(aim)
    found = least_squares_in_bounds(residual, start, lower, upper)
    other = least_squares(
        lambda q: residual(q)[0], found, lambda q: residual(q)[1], (lower, upper), xtol=1e-15, ftol=1e-15
    )
    # From where it has ended, nothing better lies downhill.
    assert cost(residual, found) <= 2.0 * other.cost * (1.0 + 1e-7) + 1e-18


def test_a_start_beyond_the_bounds_is_brought_within():
    found = least_squares_in_bounds(
        linear(np.eye(2), np.array([5.0, 0.0])), np.full(2, 9.0), -np.ones(2), np.ones(2)
    )
    np.testing.assert_allclose(found, [1.0, 0.0], atol=1e-7)


def test_variables_without_room_stay():
    lower = upper = np.array([0.3, -0.2])
    found = least_squares_in_bounds(linear(np.eye(2), np.zeros(2)), np.zeros(2), lower, upper)
    np.testing.assert_array_equal(found, lower)


def test_rows_that_are_no_numbers_end_the_search():
    def residual(x):
        return np.full(2, np.nan if x[0] != 0.0 else 1.0), np.eye(2)

    found = least_squares_in_bounds(residual, np.zeros(2), -np.ones(2), np.ones(2))
    np.testing.assert_array_equal(found, np.zeros(2))


def test_few_evaluations_do_where_the_linear_model_foretells_half():
    """Six rows that curve: from a start far off some six of them, since damping is eased as soon as that."""
    asked = []
    for seed in range(8):
        random = np.random.default_rng(seed)
        matrix, aim = random.normal(size=(6, 9)), 0.5 * random.normal(size=6)

        def curved(x, matrix=matrix, aim=aim):
            asked.append(x)
            return matrix @ np.sin(x) - aim, matrix * np.cos(x)

        found = least_squares_in_bounds(curved, np.zeros(9), np.full(9, -9.0), np.full(9, 9.0))
        np.testing.assert_allclose(matrix @ np.sin(found), aim, rtol=0, atol=1e-11)
    assert len(asked) <= 8 * 7


def test_a_damping_that_is_lost_in_rounding():
    """Two equal rows, very large: with c the matrix is singular in floats; 0 is reached where sum x = 1."""
    residual = linear(1e9 * np.ones((2, 3)), 1e9 * np.ones(2))
    bounds = -np.ones(3), np.ones(3)
    alone = least_squares_in_bounds(residual, np.zeros(3), *bounds)
    together = dict(least_squares_from([residual] * 4, [0.1 * k * np.ones(3) for k in range(4)], *bounds))
    for found in (alone, *together.values()):
        assert np.sum(found) == pytest.approx(1.0)


@pytest.mark.parametrize("seed", range(4))
def test_steps_side_by_side_are_those_of_each(seed):
    """Some variables stand on a bound, some steps would lead beyond one."""
    random = np.random.default_rng(300 + seed)
    lower, upper = -random.uniform(0.1, 0.6, 6), random.uniform(0.1, 0.6, 6)
    starts = np.clip(random.uniform(-0.8, 0.8, (8, 6)), lower, upper)
    rows = [linear(random.normal(size=(3, 6)), random.normal(size=3)) for _ in starts]
    searches = [_Search(row, start, lower, upper) for row, start in zip(rows, starts, strict=True)]
    for search in searches:
        search.damping = 10.0 ** random.uniform(-3.0, 1.0)
    found, alone = _steps(searches), np.array([_step(search) for search in searches])
    np.testing.assert_allclose(found, alone, rtol=0, atol=1e-12)
    ends = starts + alone
    assert np.any(starts == lower)
    assert np.any((ends == upper) & (starts < upper))


def test_damping_is_eased_where_little_can_be_won_and_is():
    """One row of 10 that no variable changes: of 101 a step leaves 100, as foretold."""

    def residual(x):
        return np.array([x[0] - 1.0, 10.0]), np.array([[1.0], [0.0]])

    search = _Search(residual, np.zeros(1), np.full(1, -9.0), np.full(1, 9.0))
    search.take(_step(search))
    assert search.x[0] == pytest.approx(1.0, abs=0.02)
    assert search.damping < 5e-3
