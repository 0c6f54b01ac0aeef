"""The relaxation against the objective it states: falls, is stationary, and touches what it may."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest

from irlx.pacing.slowdown.elastic_walk import Passage
from irlx.pacing.slowdown.grid import STEP, PathGrid
from irlx.pacing.slowdown.relax import Smoothing, _solve_blocks, relax
from irlx.pacing.slowdown.reserve import RESERVE, reserved
from machines import machine
from slow_cases import grid_of, jacobian_at, slow_limits, walked

pytestmark = pytest.mark.req("MOT-21")

robots = pytest.mark.parametrize("name", ["arm7", "koch11"])
SMOOTHINGS = [Smoothing(0.04, 0.0), Smoothing(0.1, 1.0), Smoothing(0.3, 1.0)]


@dataclass(frozen=True)
class Case:
    name: str
    limits: object
    grid: PathGrid
    passage: Passage
    bounds: tuple[np.ndarray, np.ndarray]
    frozen: tuple[int, ...] = ()

    def relaxed(self, smoothing: Smoothing) -> np.ndarray:
        model = machine(self.name).model(self.limits, self.frozen)
        return relax(model, self.grid, self.passage.q, self.bounds, smoothing)


@cache
def case(name: str, share: float = 0.7, frozen: tuple[int, ...] = ()) -> Case:
    limits, grid = slow_limits(name, share, cut=not frozen), grid_of(name)
    passage = walked(name, limits, frozen)
    assert passage.stopped is None
    return Case(name, limits, grid, passage, reserved(limits, grid.intervals + 1, RESERVE), frozen)


def roughness(of: Case, q: np.ndarray) -> float:
    """sum_i W |h^2 q''|^2 at the inner knots, q'' of the parabola through three of them."""
    return float(np.sum(bend(of.grid.s, q) ** 2 @ machine(of.name).weights))


def bend(s: np.ndarray, q: np.ndarray) -> np.ndarray:
    left, right = np.diff(s)[:-1, None], np.diff(s)[1:, None]
    slopes = np.diff(q, axis=0) / np.diff(s)[:, None]
    second = 2.0 * np.diff(slopes, axis=0) / (left + right)
    return (0.5 * (left + right)) ** 2 * second


def speed_excess(of: Case, q: np.ndarray) -> float:
    over = np.maximum(
        np.abs(np.diff(q, axis=0)) - 0.995 * of.limits.speed_upper * of.grid.times[:, None], 0.0
    )
    return float(np.sum(over**2 @ machine(of.name).weights))


def objective(of: Case, q: np.ndarray, smoothing: Smoothing) -> float:
    """The sum of docs/reference/pacing.md, written down once more."""
    weights = machine(of.name).weights
    near = (of.grid.step / smoothing.tau) ** 4 * np.sum((q - of.passage.q) ** 2 @ weights)
    out = np.maximum(np.maximum(q - of.bounds[1], of.bounds[0] - q), 0.0)
    fast = smoothing.mu * (of.grid.step / STEP) ** 2 * speed_excess(of, q)
    return roughness(of, q) + float(near) + fast + 1e5 * float(np.sum(out**2 @ weights))


@robots
@pytest.mark.parametrize("smoothing", SMOOTHINGS)
def test_ends_stay_and_every_knot_is_on_its_pose(name: str, smoothing: Smoothing) -> None:
    of = case(name)
    q = of.relaxed(smoothing)
    assert np.all(q[[0, -1]] == of.passage.q[[0, -1]])
    assert max(machine(name).errors(q, of.grid.poses)) < 1e-9
    assert np.max(np.abs(q - of.passage.q)) > 1e-4


@robots
def test_roughness_falls_the_more_the_longer_the_waves(name: str) -> None:
    of = case(name)
    rough = [roughness(of, of.passage.q)]
    rough += [roughness(of, of.relaxed(Smoothing(tau, 0.0))) for tau in (0.04, 0.1, 0.3)]
    assert all(after < before for before, after in itertools.pairwise(rough)), rough


@robots
def test_a_price_on_speed_lowers_its_excess(name: str) -> None:
    of = case(name)
    free, priced = (speed_excess(of, of.relaxed(Smoothing(0.1, mu))) for mu in (0.0, 1.0))
    assert priced < 0.97 * free


@robots
@pytest.mark.parametrize("smoothing", SMOOTHINGS)
def test_the_objective_falls(name: str, smoothing: Smoothing) -> None:
    of = case(name)
    assert objective(of, of.relaxed(smoothing), smoothing) < objective(of, of.passage.q, smoothing)


@pytest.mark.parametrize("smoothing", SMOOTHINGS[1:])
def test_a_start_that_is_off_by_rounding_leads_to_the_same_objective(smoothing: Smoothing) -> None:
    """Full steps of Newton's method went to and fro between sets of hinges, halved ones stopped too soon."""
    of = case("koch11")
    ends = [moved_by_rounding(of, seed).relaxed(smoothing) for seed in range(8)]
    found = [objective(of, end, smoothing) for end in ends]
    assert max(found) < 1.0001 * min(found)
    steep = np.max(np.abs(slopes(of, of.passage.q, smoothing)))
    assert all(np.max(np.abs(slopes(of, end, smoothing))) < 0.005 * steep for end in ends)


def moved_by_rounding(of: Case, seed: int) -> Case:
    noise = 1e-13 * np.random.default_rng(seed).normal(size=of.passage.q.shape)
    noise[[0, -1]] = 0.0
    return replace(of, passage=replace(of.passage, q=of.passage.q + noise))


@robots
@pytest.mark.parametrize("smoothing", SMOOTHINGS)
def test_the_result_is_stationary(name: str, smoothing: Smoothing) -> None:
    """Slopes of the stated objective along the null space, by central differences, before and after."""
    of = case(name)
    before, after = slopes(of, of.passage.q, smoothing), slopes(of, of.relaxed(smoothing), smoothing)
    assert min(before.size, after.size) > 10
    assert np.max(np.abs(after)) < 0.02 * np.max(np.abs(before))


def slopes(of: Case, q: np.ndarray, smoothing: Smoothing) -> np.ndarray:
    robot, h, found = machine(of.name), 1e-7, []
    room = np.minimum(of.bounds[1] - q, q - of.bounds[0]).min(axis=1)
    # Beside a knot on its position bound the objective has a corner as steep as 1E5.
    for knot in np.flatnonzero(room[2:-2] > 2e-5)[::5] + 2:
        for direction in np.linalg.svd(jacobian_at(robot, q[knot]))[2][6:]:
            sides = []
            for sign in (1.0, -1.0):
                moved = q.copy()
                moved[knot] += sign * h * direction
                sides.append(objective(of, moved, smoothing))
            found.append((sides[0] - sides[1]) / (2.0 * h))
    return np.array(found)


@robots
@pytest.mark.req("MOT-20")
def test_positions_are_left_by_no_more_than_the_reserve(name: str) -> None:
    of = case(name)
    q = of.relaxed(Smoothing(0.3, 1.0))
    assert np.max(np.maximum(q - of.bounds[1], of.bounds[0] - q)) < RESERVE


def test_frozen_joints_keep_their_bits() -> None:
    of = case("koch11", 0.8, (1, 4))
    q = of.relaxed(Smoothing(0.1, 1.0))
    assert np.all(q[:, [1, 4]] == machine("koch11").start[[1, 4]])
    assert np.max(np.abs(q - of.passage.q)) > 1e-5
    assert max(machine("koch11").errors(q, of.grid.poses)) < 1e-9


def test_six_free_joints_leave_nothing_to_smooth() -> None:
    of = case("arm7", 5.0, (2,))
    q = of.relaxed(Smoothing(0.1, 1.0))
    assert np.all(q == of.passage.q)


@pytest.mark.parametrize(("count", "r"), [(1, 2), (2, 1), (3, 2), (9, 1), (9, 4)])
def test_the_block_band_system_is_that_of_the_dense_matrix(count: int, r: int) -> None:
    rng = np.random.default_rng(count * 10 + r)
    whole = 20.0 * np.eye(count * r)
    blocks = [rng.uniform(-1.0, 1.0, (max(count - k, 0), r, r)) for k in range(3)]
    blocks[0] = blocks[0] + blocks[0].transpose(0, 2, 1) + 20.0 * np.eye(r)
    for k, beside in enumerate(blocks):
        for i, block in enumerate(beside):
            rows, columns = (slice(j * r, (j + 1) * r) for j in (i, i + k))
            whole[rows, columns], whole[columns, rows] = block, block.T
    right = rng.uniform(-1.0, 1.0, (count, r))
    expected = np.linalg.solve(whole, right.ravel()).reshape(count, r)
    np.testing.assert_allclose(_solve_blocks(*blocks, right), expected, rtol=0, atol=1e-14)
