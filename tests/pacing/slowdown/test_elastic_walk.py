"""The elastic walk against plain Newton steps and, interval by interval, a second quadratic solver."""

from __future__ import annotations

import daqp
import numpy as np
import pytest

from irlx.motion.trapezoid import Trapezoid
from irlx.pacing.slowdown import elastic_walk as elastic_walk_module
from irlx.pacing.slowdown.elastic_walk import (
    Passage,
    _least_cost,
    _many_unknowns,
    _one_unknown,
    _Steps,
    _Stretch,
    _within_sides,
    elastic_walk,
)
from irlx.pacing.slowdown.grid import PathGrid, path_grid
from irlx.pacing.slowdown.reserve import RESERVE, reserved
from irlx.pacing.slowdown.room import Room
from irlx.transform.clearance import SideRows
from irlx.transform.criteria.least_motion import LeastMotion
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.tick import TickSolver
from irlx.transform.tick_problem import TickProblem
from long_run import first, first_rows
from machines import least_motion, machine
from slow_cases import free_rows, grid_of, jacobian_at, slow_limits, used, walked

pytestmark = pytest.mark.req("MOT-21")

robots = pytest.mark.parametrize("name", first(1, ["arm7", "koch11"]))


@robots
def test_without_bounds_it_is_a_plain_least_motion_walk(name: str) -> None:
    passage = walked(name, machine(name).unlimited())
    assert passage.stopped is None
    np.testing.assert_allclose(passage.q, free_rows(name), atol=1e-9)
    assert not np.any(passage.stretch)


@robots
def test_bounds_that_do_not_bind_change_nothing(name: str) -> None:
    fast = 1.05 * used(name)
    limits = machine(name).unlimited().with_pair("speed", -fast, fast)
    np.testing.assert_allclose(walked(name, limits).q, free_rows(name), atol=1e-9)


def braking(room: float, a: float, dt: float) -> float:
    """Fastest speed from which whole steps of deceleration stop within `room`: by bisection on the stop."""
    low, high = 0.0, 10.0 * np.sqrt(a * room) + room / dt + a * dt
    for _ in range(80):
        v = 0.5 * (low + high)
        speeds = v - a * dt * np.arange(int(v / (a * dt)) + 1)
        low, high = (v, high) if np.sum(speeds) * dt <= room else (low, v)
    return low


def stated_bounds(limits, q: np.ndarray, bounds, duration: float):
    """Position room and stretchable bounds of an interval, written from the specification."""
    low = np.maximum(np.minimum(bounds[0], q + RESERVE / 12), limits.position_lower) - q
    high = np.minimum(np.maximum(bounds[1], q - RESERVE / 12), limits.position_upper) - q
    sides = []
    for room, speed, a in (
        (np.maximum(-low, 0.0), -limits.speed_lower, limits.acceleration_upper),
        (np.maximum(high, 0.0), limits.speed_upper, -limits.acceleration_lower),
    ):
        brake = [braking(r, 0.9 * b, duration) if r < 1.0 else np.inf for r, b in zip(room, a, strict=True)]
        sides.append(duration * np.minimum(speed, brake))
    return low, high, *sides


def second_opinion(name: str, limits, grid: PathGrid, passage: Passage, i: int) -> tuple[float, float]:
    """How far another solver would move the step (as a share of it) and the stretch of interval i.

    The stated problem, linear about the step found: the step is right where it is its own best answer.
    """
    robot, q, dt = machine(name), passage.q[i], float(grid.times[i])
    step, unit = passage.q[i + 1] - q, float(np.max(np.abs(passage.q[i + 1] - q)))
    reserves = reserved(limits, grid.intervals + 1, RESERVE)
    low, high, down, up = stated_bounds(limits, q, (reserves[0][i + 1], reserves[1][i + 1]), dt)
    price = float(robot.weights @ np.minimum(limits.speed_upper, -limits.speed_lower) ** 2)
    basis = np.linalg.svd(jacobian_at(robot, q + step))[2][6:].T * unit
    r = basis.shape[1]
    hessian, slope = np.zeros((r + 1, r + 1)), np.zeros(r + 1)
    hessian[:r, :r] = (basis.T * robot.weights) @ basis / dt**2
    hessian[r, r], slope[:r], slope[r] = price * 1e-3, basis.T @ (robot.weights * step) / dt**2, price
    zero, eps = np.zeros((robot.n, 1)), np.append(np.zeros(r), 1.0)
    rows = np.vstack(
        [np.hstack([basis, zero]), np.hstack([basis, -up[:, None]]), np.hstack([-basis, -down[:, None]]), eps]
    )
    scale = np.append(np.full(3 * robot.n, unit), 1.0)
    above = np.concatenate([high - step, up - step, down + step, [1e9]]) / scale
    below = np.concatenate([low - step, np.full(2 * robot.n, -1e30), [0.0]]) / scale
    found, _, flag, _ = daqp.solve(hessian / price, slope / price, rows / scale[:, None], above, below)
    assert flag == 1, flag
    return float(np.max(np.abs(basis @ found[:r]))) / unit, abs(float(found[r] - passage.stretch[i]))


@pytest.mark.parametrize(("name", "share"), first_rows(2, [("arm7", 0.85), ("arm7", 0.5), ("koch11", 0.5)]))
def test_steps_are_the_best_ones_in_the_eyes_of_another_solver(name: str, share: float) -> None:
    limits, grid = slow_limits(name, share), grid_of(name)
    passage = walked(name, limits)
    assert passage.stopped is None
    assert np.count_nonzero(passage.stretch > 1e-3) > 5
    for i in range(1, grid.intervals - 1, 11):
        moved, stretched = second_opinion(name, limits, grid, passage, i)
        assert moved <= 1e-4, i
        assert stretched <= 1e-4, i


@robots
def test_knots_are_on_the_path_and_inside_the_positions(name: str) -> None:
    for seed in range(2):
        limits, grid = slow_limits(name, 0.6, seed), grid_of(name)
        passage = walked(name, limits)
        distance, angle = machine(name).errors(passage.q, grid.poses)
        assert max(distance, angle) < 1e-9
        assert np.all(limits.position_lower <= passage.q)
        assert np.all(passage.q <= limits.position_upper)


@robots
def test_no_step_is_longer_than_its_stretched_bounds(name: str) -> None:
    limits, grid = slow_limits(name, 0.5), grid_of(name)
    passage = walked(name, limits)
    allowed = limits.speed_upper * grid.times[:, None] * (1.0 + passage.stretch[:, None])
    assert np.all(np.abs(np.diff(passage.q, axis=0)) <= allowed * (1.0 + 1e-9) + 1e-12)


@robots
@pytest.mark.req("MOT-20")
def test_a_start_on_its_limit_is_led_inside(name: str) -> None:
    """Within a few dozen knots the joint is a reserve away from the limit on which it began."""
    robot = machine(name)
    joint = int(np.argmax(np.abs(free_rows(name)[-1] - robot.start)))
    lower, upper = (side.copy() for side in robot.unlimited().pair("position"))
    rising = free_rows(name)[-1, joint] > robot.start[joint]
    (upper if rising else lower)[joint] = robot.start[joint]
    passage = walked(name, robot.unlimited().with_pair("position", lower, upper))
    assert passage.stopped is None
    way = np.abs(passage.q[:, joint] - robot.start[joint])
    assert np.all((lower <= passage.q) & (passage.q <= upper))
    assert np.all(way[14:-14] >= RESERVE * (1.0 - 1e-9))
    assert np.max(np.diff(way)[:11]) <= RESERVE / 12 * (1.0 + 1e-6)


@pytest.mark.req("MOT-22")
def test_a_way_out_of_reach_is_stopped_at_the_first_interval_without_a_step() -> None:
    """arm7 stretches to its reach of the line; the interval is where the arm is straight."""
    robot = machine("arm7")
    path = robot.line((1.5, 0.0, 0.0))
    grid = path_grid(path, Trapezoid.fastest(path.length, 0.5, 2.0))
    least, limits = LeastMotion(robot.weights), robot.unlimited()
    bounds = reserved(limits, grid.intervals + 1, RESERVE)
    passage = elastic_walk(robot.model(limits), grid, robot.start, lambda s, _: least, bounds, RESERVE)
    assert passage.stopped is not None
    interval, solution = passage.stopped
    assert len(passage.q) == interval + 1
    assert not solution.solved
    wrist = robot_wrist(passage.q[-1])
    assert 0.99 < wrist <= 1.0 + 1e-9


def robot_wrist(q: np.ndarray) -> float:
    """How straight the elbow stands: distance of shoulder and wrist as a share of the two links."""
    return float(np.abs(np.cos(q[3] / 2.0)))


@robots
def test_frozen_joints_keep_their_bits(name: str) -> None:
    robot, grid = machine(name), grid_of(name)
    least, limits = LeastMotion(robot.weights), slow_limits(name, 0.8)
    bounds = reserved(limits, grid.intervals + 1, RESERVE)
    passage = elastic_walk(robot.model(limits, (2,)), grid, robot.start, lambda s, _: least, bounds, RESERVE)
    assert np.all(passage.q[:, 2] == robot.start[2])


def cost(z: np.ndarray, at: np.ndarray, rise: np.ndarray, price: float) -> np.ndarray:
    stretch = np.max(at[:, None] + rise[:, None] * z, axis=0)
    return 0.5 * z**2 + price * (stretch + stretch**2 / 2000)


@pytest.mark.parametrize("seed", range(60))
def test_the_one_unknown_is_where_no_other_value_costs_less(seed: int) -> None:
    """Against all values that can be: where a line's own parabola is lowest, where two meet, the ends."""
    rng = np.random.default_rng(seed)
    lines = int(rng.integers(1, 15))
    at = np.append(0.0, rng.normal(size=lines) * 10.0 ** rng.uniform(-3, 1))
    rise = np.append(0.0, rng.normal(size=lines) * 10.0 ** rng.uniform(-3, 3))
    if seed % 4 == 0:
        # Duplicates, level lines and ones that meet in one place.
        at[1:], rise[1:] = rng.integers(-2, 3, lines), rng.integers(-2, 3, lines)
    if seed % 5 == 0:
        at[1:] += 1e-16
    price = float(10.0 ** rng.uniform(-12, 2))
    least, most = sorted((rng.normal(size=2) * 10.0 ** rng.uniform(-3, 2)).tolist())
    least, most = (-np.inf if seed % 3 == 0 else least), (np.inf if seed % 7 == 0 else most)
    z, stretch = _least_cost(at, rise, price, least, most)
    assert least <= z <= most
    assert stretch == np.max(at + rise * z)
    own = -price * rise * (1.0 + 1e-3 * at) / (1.0 + 1e-3 * price * rise**2)
    with np.errstate(divide="ignore", invalid="ignore"):
        meet = ((at[:, None] - at) / (rise - rise[:, None])).ravel()
    tried = np.clip(np.concatenate([own, meet[np.isfinite(meet)], [0.0]]), least, most)
    best = float(np.min(cost(tried, at, rise, price)))
    assert float(cost(np.array([z]), at, rise, price)[0]) <= best + 1e-12 * max(abs(best), 1e-12), (
        f"seed {seed}"
    )


@pytest.mark.parametrize("seed", range(8))
def test_many_unknowns_of_which_one_moves_anything_are_that_one(seed: int) -> None:
    """The quadratic problem in step and stretch against the search along lines, which has another form."""
    rng = np.random.default_rng(seed)
    slope, target, wide = rng.normal(size=5), rng.normal(size=5), np.full(5, 4.0)
    up, down = rng.uniform(0.1, 1.0, (2, 5))
    up[0] = down[1] = np.inf
    room, price = Room(-wide, wide, down, up, 1.0), float(10.0 ** rng.uniform(-2.0, 1.0))
    step, stretch = _one_unknown(slope[:, None], target, room, price, None)
    assert stretch > 0.0
    rows = np.stack([np.zeros(5), slope, np.zeros(5)], axis=1)
    (found, other), _ = _many_unknowns(rows, target, room, price, None, None)
    np.testing.assert_allclose(found, step, rtol=0, atol=1e-9)
    assert other == pytest.approx(stretch, rel=1e-7)


# ---- one interval


def interval(name: str) -> tuple[TickProblem, Room]:
    """The first interval of the usual line taken ten knots long, with nothing in its way."""
    robot, grid = machine(name), grid_of(name)
    model, n = robot.model(robot.unlimited()), robot.n
    wide = np.full(n, np.inf)
    room = Room(-wide, wide, wide, wide, float(np.sum(grid.times[:10])))
    target = model.targets(grid.poses)[10]
    return TickProblem(target, robot.start, room.none(), LeastMotion(robot.weights), model.free, None), room


@robots
@pytest.mark.parametrize("off", [0.0, 0.02])
def test_a_stretch_without_bounds_is_the_least_step_wherever_it_is_sought_from(name: str, off: float) -> None:
    robot, grid = machine(name), grid_of(name)
    problem, room = interval(name)
    model = robot.model(robot.unlimited())
    begin = off * np.random.default_rng(2).normal(size=robot.n)
    found = _Stretch(model, TickSolver(model.kinematics, ProxQpSolver()), problem, room, 1e-9).solve(begin)
    assert found is not None
    step, stretch = found
    poses = type(grid.poses)(grid.poses.position[10:11], grid.poses.rotation[10:11])
    wanted = least_motion(robot, poses, robot.start)[0] - robot.start
    np.testing.assert_allclose(step, wanted, atol=1e-8)
    assert stretch == 0.0


def test_where_the_way_so_far_leads_nowhere_a_step_is_sought_from_where_the_joints_are(monkeypatch) -> None:
    robot = machine("arm7")
    problem, _ = interval("arm7")
    tight = np.full(7, 1e-9)
    room = Room(-np.full(7, np.inf), np.full(7, np.inf), tight, tight, 0.04)
    begins = []

    class Lost(_Stretch):
        def solve(self, begin):
            begins.append(begin)
            return None if len(begins) == 1 else super().solve(begin)

    monkeypatch.setattr(elastic_walk_module, "_Stretch", Lost)
    continued = np.full(7, 0.3)
    found = _Steps(robot.model(robot.unlimited()), RESERVE, False).step(problem, room, continued, 0.0)
    assert isinstance(found, tuple)
    assert found[1] > 0.0
    assert [begin.tolist() for begin in begins] == [continued.tolist(), [0.0] * 7]


@pytest.mark.parametrize("seed", range(20))
def test_the_one_unknown_keeps_all_inequalities_between_two_ends(seed: int) -> None:
    """Slopes steep and flat of both signs, against a fine row of values; level ones hold or they do not."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 5))
    slopes = rng.choice([-3.0, -0.4, 0.0, 0.2, 0.7, 5.0], count)
    bounds = rng.uniform(-1.0, 0.4, count)
    least, most = _within_sides(SideRows(slopes[:, None], bounds), -2.0, 2.0)
    tried = np.linspace(-2.0, 2.0, 4001)
    keeps = np.all(slopes[:, None] * tried >= bounds[:, None], axis=0)
    inside = (tried >= least) & (tried <= most)
    edge = np.minimum(np.abs(tried - least), np.abs(tried - most)) < 1e-9
    assert np.array_equal(keeps[~edge], inside[~edge])


@pytest.mark.parametrize("lost", [[0], [3, 5], list(range(7))])
def test_a_step_that_is_no_number_in_some_joint_ends_the_search(lost: list[int]) -> None:
    """What the next round would begin with is no posture."""
    robot = machine("arm7")
    model = robot.model(robot.unlimited())
    problem, room = interval("arm7")
    rounds = []

    class Lost(_Stretch):
        def _round(self, whole):
            rounds.append(whole)
            return np.where(np.isin(np.arange(7), lost), np.nan, 0.1), 0.0

    solver = TickSolver(model.kinematics, ProxQpSolver())
    assert Lost(model, solver, problem, room, 1e-9).solve(np.zeros(7)) is None
    assert len(rounds) == 1


@pytest.mark.parametrize("off", [0.0, 1e-3])
def test_a_step_that_leads_nowhere_is_none(off: float, monkeypatch) -> None:
    """Steps have become small, and one coordinate of the pose is not met."""
    robot = machine("arm7")
    position, rotation = robot.pose(robot.start)
    target = robot.kinematics.target(rotation, position + rotation @ [off, 0.0, 0.0])
    least, free = LeastMotion(robot.weights), np.ones(7, dtype=bool)
    problem, step = TickProblem(target, robot.start, None, least, free), np.zeros(7)
    stretch = _Stretch(robot.model(), None, problem, None, 1e-9)
    monkeypatch.setattr(stretch, "_round", lambda whole: (step, 0.25))
    found = stretch.solve(np.zeros(7))
    assert (found is None) is (off > 0.0)
    assert found is None or found[1] == 0.25
