"""The relaxation against the objective it states: falls, is stationary, and touches what it may."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field, replace
from functools import cache

import numpy as np
import pytest

from irlx.motion.pose_path import Poses
from irlx.motion.trapezoid import Trapezoid
from irlx.pacing.slowdown import relax as relax_module
from irlx.pacing.slowdown.curve import JointCurve
from irlx.pacing.slowdown.elastic_walk import Passage
from irlx.pacing.slowdown.grid import STEP, PathGrid, Spacing, path_grid
from irlx.pacing.slowdown.model import Model, null_spaces
from irlx.pacing.slowdown.near_knots import NearKnots
from irlx.pacing.slowdown.relax import _GOLDEN, Smoothing, _Relaxation, _solve_blocks, relax
from irlx.pacing.slowdown.reserve import RESERVE, reserved
from long_run import first
from machines import least_motion, machine
from slow_cases import WAYS, grid_of, jacobian_at, slow_limits, walked

pytestmark = pytest.mark.req("MOT-21")

robots = pytest.mark.parametrize("name", first(1, ["arm7", "koch11"]))
SMOOTHINGS = [Smoothing(0.04, 0.0), Smoothing(0.1, 1.0), Smoothing(0.3, 1.0)]
some = pytest.mark.parametrize(
    ("name", "smoothing"),
    [
        pytest.param(name, smoothing, marks=pytest.mark.slow if name == "koch11" and number != 1 else ())
        for name in ("arm7", "koch11")
        for number, smoothing in enumerate(SMOOTHINGS)
    ],
)


@dataclass(frozen=True)
class Case:
    name: str
    limits: object
    grid: PathGrid
    passage: Passage
    bounds: tuple[np.ndarray, np.ndarray]
    frozen: tuple[int, ...] = ()
    done: dict[Smoothing, np.ndarray] = field(default_factory=dict)

    def relaxed(self, smoothing: Smoothing) -> np.ndarray:
        """Rows relaxed from those of the passage, once for all tests of a case."""
        if smoothing not in self.done:
            self.done[smoothing] = self._relaxed(smoothing)
        return self.done[smoothing]

    def _relaxed(self, smoothing: Smoothing) -> np.ndarray:
        model = machine(self.name).model(self.limits, self.frozen)
        return relax(model, self.grid, self.passage.q, self.bounds, smoothing)


@cache
def case(name: str, share: float = 0.7, frozen: tuple[int, ...] = ()) -> Case:
    limits, grid = slow_limits(name, share, cut=not frozen), grid_of(name)
    passage = walked(name, limits, frozen)
    assert passage.stopped is None
    return Case(name, limits, grid, passage, reserved(limits, grid.intervals + 1, RESERVE), frozen)


def roughness(of: Case, q: np.ndarray) -> float:
    """sum_i a_i W |h^2 q''|^2 at the inner knots, q'' of the parabola through three of them."""
    return float(np.sum(bend(of.grid.s, q) ** 2 @ machine(of.name).weights))


def bend(s: np.ndarray, q: np.ndarray) -> np.ndarray:
    left, right = np.diff(s)[:-1, None], np.diff(s)[1:, None]
    slopes = np.diff(q, axis=0) / np.diff(s)[:, None]
    second = 2.0 * np.diff(slopes, axis=0) / (left + right)
    return np.max(np.diff(s)) ** 2 * np.sqrt(shares_at(s)[1:-1, None]) * second


def shares_at(s: np.ndarray) -> np.ndarray:
    """Mean width of the intervals beside each knot, in parts of the widest one."""
    widths = np.pad(np.diff(s), 1, mode="edge")
    return np.convolve(widths, [0.5, 0.5], mode="valid") / np.max(widths)


def speed_excess(of: Case, q: np.ndarray) -> float:
    over = np.maximum(
        np.abs(np.diff(q, axis=0)) - 0.995 * of.limits.speed_upper * of.grid.times[:, None], 0.0
    )
    return float(np.sum(over**2 @ machine(of.name).weights))


def objective(of: Case, q: np.ndarray, smoothing: Smoothing) -> float:
    """The sum of docs/reference/pacing.md, written down once more."""
    weights = machine(of.name).weights
    near = (of.grid.step / smoothing.tau) ** 4 * shares_at(of.grid.s) @ ((q - of.passage.q) ** 2 @ weights)
    out = np.maximum(np.maximum(q - of.bounds[1], of.bounds[0] - q), 0.0)
    fast = smoothing.mu * (of.grid.step / STEP) ** 2 * speed_excess(of, q)
    return roughness(of, q) + float(near) + fast + 1e5 * float(np.sum(out**2 @ weights))


@some
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


@pytest.mark.parametrize("count", first(1, [2, 8]))
@pytest.mark.parametrize("smoothing", first(1, SMOOTHINGS[:0:-1]))
def test_a_start_that_is_off_by_rounding_leads_to_the_same_objective(
    smoothing: Smoothing, count: int
) -> None:
    """Full steps of Newton's method went to and fro between sets of hinges, halved ones stopped too soon."""
    of = case("koch11")
    ends = [moved_by_rounding(of, seed).relaxed(smoothing) for seed in range(count)]
    found = [objective(of, end, smoothing) for end in ends]
    assert max(found) < 1.0001 * min(found)
    steep = np.max(np.abs(slopes(of, of.passage.q, smoothing)))
    assert all(np.max(np.abs(slopes(of, end, smoothing))) < 0.005 * steep for end in ends)


def moved_by_rounding(of: Case, seed: int) -> Case:
    noise = 1e-13 * np.random.default_rng(seed).normal(size=of.passage.q.shape)
    noise[[0, -1]] = 0.0
    return replace(of, done={}, passage=replace(of.passage, q=of.passage.q + noise))


@some
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


@pytest.mark.parametrize("smoothing", SMOOTHINGS)
def test_knots_that_crowd_bring_no_bends(smoothing: Smoothing) -> None:
    """Beside some knots there is one more, a twentieth of an interval away, as where phases of a law meet."""
    of, robot = case("arm7"), machine("arm7")
    s = of.grid.s
    crowded = np.sort(np.append(s, s[10:-10:9] + 0.05 * np.diff(s)[10:-9:9]))
    path = robot.line(WAYS["arm7"], (0.1, -0.2, 0.15))
    times = np.diff(np.interp(crowded, s, np.append(0.0, np.cumsum(of.grid.times))))
    rates = np.interp(crowded, s, of.grid.rates)
    grid = PathGrid(crowded, times, rates, path.poses(crowded), of.grid.step)
    bounds = reserved(of.limits, grid.intervals + 1, RESERVE)
    walk = JointCurve(s, of.passage.q).at(crowded)
    q = relax(robot.model(of.limits), grid, walk, bounds, smoothing)
    evenly = of.relaxed(smoothing)
    assert np.max(np.abs(q[np.isin(crowded, s)] - evenly)) < 2e-4
    most = [
        np.max(np.abs(JointCurve(knots, rows).derivatives(knots)[1]))
        for knots, rows in ((s, evenly), (crowded, q))
    ]
    assert most[1] < 1.5 * most[0]


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


# ---- one linearisation


@dataclass(frozen=True)
class Few:
    """arm7 on a dozen knots, its postures off their walk, a speed limit and a position limit passed."""

    model: Model
    grid: PathGrid
    q: np.ndarray
    walk: np.ndarray
    bounds: tuple[np.ndarray, np.ndarray]
    near: NearKnots | None

    def relaxation(self, smoothing: Smoothing) -> _Relaxation:
        jacobians = self.model.differences(self.q, self.model.targets(self.grid.poses))[1]
        basis = null_spaces(jacobians)
        arguments = self.model, self.grid, self.q, basis, self.walk, self.bounds, smoothing, (4,), self.near
        return _Relaxation(*arguments)

    def objective(self, q: np.ndarray, smoothing: Smoothing) -> float:
        """The stated sum for postures q, as it is written at the head of the module."""
        w, limits, ratio = self.model.weights, self.model.limits, (self.grid.step / STEP) ** 2
        pull = (self.grid.step / smoothing.tau) ** 4 * shares_at(self.grid.s)
        pull[4] = 1e5
        steps, times = np.diff(q, axis=0), self.grid.times[:, None]
        fast = np.maximum(steps - 0.995 * limits.speed_upper * times, 0.0)
        fast += np.maximum(0.995 * limits.speed_lower * times - steps, 0.0)
        out = np.maximum(np.maximum(q - self.bounds[1], self.bounds[0] - q), 0.0)
        found = np.sum(bend(self.grid.s, q) ** 2 @ w) + pull @ ((q - self.walk) ** 2 @ w)
        found += smoothing.mu * ratio * np.sum(fast**2 @ w) + 1e5 * np.sum(out**2 @ w)
        if self.near is not None:
            for knot, room, rate in zip(self.near.knots, self.near.room, self.near.rates, strict=True):
                lacking = max(-(room + rate @ (q - self.q)[knot]), 0.0)
                found += 1e5 * np.mean(w) * lacking**2 / (rate @ rate)
        return float(found)


def few(near: bool, limited: bool = True) -> Few:
    robot, rng = machine("arm7"), np.random.default_rng(3)
    path = robot.line((0.0, -0.2, 0.1))
    grid = path_grid(path, Trapezoid.fastest(path.length, 0.25, 1.5), Spacing(20.0, 12))
    walk = np.vstack([robot.start, least_motion(robot, poses_behind(grid), robot.start)])
    q = walk + 0.003 * rng.normal(size=walk.shape)
    limits, side = robot.unlimited(), np.full(walk.shape, np.inf)
    upper, lower = side.copy(), -side
    if limited:
        steps = np.diff(q, axis=0) / grid.times[:, None]
        limits = limits.with_pair("speed", 0.9 * steps.min(axis=0), 0.8 * steps.max(axis=0))
        upper[:, 1], lower[:, 3] = np.max(q[:, 1]) - 0.003, np.min(q[:, 3]) + 0.002
    rates = rng.normal(size=(4, 7))
    pairs = NearKnots(np.array([2, 5, 5, 9]), np.array([-0.004, 0.002, -0.001, 0.03]), rates)
    return Few(robot.model(limits), grid, q, walk, (lower, upper), pairs if near else None)


def poses_behind(grid: PathGrid) -> Poses:
    return Poses(grid.poses.position[1:], grid.poses.rotation[1:])


@pytest.mark.parametrize("near", [False, True])
def test_the_sum_is_the_stated_one(near: bool) -> None:
    of, smoothing = few(near), Smoothing(0.1, 1.0)
    rng = np.random.default_rng(1)
    relaxation = of.relaxation(smoothing)
    for size in (0.0, 1e-3, 3e-2):
        change = size * rng.normal(size=of.q.shape)
        wanted = of.objective(of.q + change, smoothing)
        assert relaxation._sum(change) == pytest.approx(wanted, rel=1e-9)


@pytest.mark.parametrize("limited", [False, True])
def test_the_slope_of_the_sum_by_differences(limited: bool) -> None:
    """With all hinges that act at the postures themselves, on both sides of speeds and positions."""
    of, centre = few(True, limited), np.zeros(7)
    half = np.full(of.q.shape, np.inf)
    if limited:
        centre[1:4], half[:, 1:4] = np.median(of.q[:, 1:4], axis=0), 0.002
    relaxation = replace(of, bounds=(centre - half, centre + half)).relaxation(Smoothing(0.1, 1.0))
    nothing = np.zeros_like(of.q)
    active = relaxation._hinges(nothing)
    if limited:
        assert all({-1, 1} <= set(side[1:-1].ravel().tolist()) for side in active[:2])
    _, slope = relaxation._with_hinges(*relaxation._smooth_part(), active)
    for knot in range(1, len(of.q) - 1):
        sums = []
        for size in (1e-6, -1e-6):
            change = nothing.copy()
            change[knot] = size * relaxation._basis[knot][:, 0]
            sums.append(relaxation._sum(change))
        # Nobody halves the squares of the sum.
        assert 2.0 * slope[knot - 1, 0] == pytest.approx((sums[0] - sums[1]) / 2e-6, rel=1e-4, abs=1e-4)


@pytest.mark.parametrize("near", [False, True])
@pytest.mark.parametrize("limited", [False, True])
def test_no_step_on_the_null_spaces_lowers_the_sum_below_that_of_the_step(near: bool, limited: bool) -> None:
    """The sum is convex there: where small changes of single knots cost, all others do as well."""
    of, smoothing = few(near, limited), Smoothing(0.1, 1.0)
    relaxation = of.relaxation(smoothing)
    step = np.zeros_like(of.q)
    step[1:-1] = relaxation.step()
    least = relaxation._sum(step)
    assert least < 0.9 * relaxation._sum(np.zeros_like(step))
    for knot in range(1, len(step) - 1):
        for size in (1e-4, -1e-4):
            other = step.copy()
            other[knot] += size * relaxation._basis[knot][:, 0]
            assert relaxation._sum(other) > least


def test_what_is_near_is_looked_for_where_something_is_kept_clear(monkeypatch) -> None:
    """In every round about the postures that it begins with; without a clearance nobody asks."""
    asked: list[np.ndarray] = []

    def near_knots(model, grid, q, reserve):
        assert reserve == 0.002
        asked.append(q)
        return of.near

    monkeypatch.setattr(relax_module, "near_knots", near_knots)
    of, smoothing = few(True, limited=False), Smoothing(0.1, 1.0)
    arguments = of.grid, of.walk, of.bounds, smoothing, (), 0.002
    alone = relax(of.model, *arguments)
    assert not asked
    kept = relax(replace(of.model, clearance=object()), *arguments)
    assert np.array_equal(asked[0], of.walk)
    # The linear room that was lacking is made.
    assert np.max(np.abs(kept - alone)) > 1e-4


@pytest.mark.parametrize("lowest", [0.0, 0.003, 0.25, 0.381966, 0.5, 0.99, 1.0])
def test_sections_end_where_they_do_when_no_sum_is_used_again(monkeypatch, lowest):
    """Bit for bit, at half the sums."""
    asked = []

    def bowl(_, change):
        asked.append(float(change[0, 0]))
        return 1.0 + (asked[-1] - lowest) ** 2

    monkeypatch.setattr(_Relaxation, "_sum", bowl)
    relaxation = _Relaxation.__new__(_Relaxation)
    good, worse = np.zeros((1, 1)), np.ones((1, 1))
    found = float(relaxation._lowest_between(good, worse)[0, 0])
    low, high = 0.0, 1.0
    for _ in range(12):
        inner, outer = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
        if 1.0 + (inner - lowest) ** 2 < 1.0 + (outer - lowest) ** 2:
            high = outer
        else:
            low = inner
    assert found == 0.5 * (low + high)
    # Where two sums are alike both are made anew, as in the middle.
    assert lowest == 0.5 or len(asked) <= 16
