"""Whole motions planned: rows judged by the verifier's kinematics and by differences; refusals."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

from irlx.motion.pose_path import Poses
from irlx.motion.trapezoid import Trapezoid
from irlx.pacing.resolution import Resolution
from irlx.pacing.slowdown import ladder, planned
from irlx.pacing.slowdown.clock import plan_clock
from irlx.pacing.slowdown.clock_bounds import Governor, Reserves, clock_bounds
from irlx.pacing.slowdown.curve import JointCurve
from irlx.pacing.slowdown.grid import path_grid
from irlx.pacing.slowdown.ladder import TimedCurve
from irlx.pacing.slowdown.planned import PlannedMotion, Refusal, plan_motion, rows_on_clock
from irlx.transform.clearance import TooNear
from long_run import first, first_rows
from machines import least_motion, machine
from slow_cases import SPEEDS, WAYS, jacobian_at, slow_limits, used
from stream_judge import excess

pytestmark = pytest.mark.req("MOT-20")

KINDS = ("position", "speed", "acceleration")
robots = pytest.mark.parametrize("name", ["arm7", "koch11"])
of_seven = pytest.mark.parametrize("name", first(1, ["arm7", "koch11"]))


def plan(name: str, limits, dt: float, frozen: tuple[int, ...] = ()) -> PlannedMotion | Refusal:
    robot = machine(name)
    path = robot.line(WAYS[name], (0.1, -0.2, 0.15))
    law = Trapezoid.fastest(path.length, *SPEEDS[name])
    return plan_motion(robot.model(limits, frozen), robot.task(path, law, dt))


@cache
def slowed(name: str, dt: float) -> PlannedMotion | Refusal:
    """The motion under limits that slow it down, once for all tests that look at it."""
    return plan(name, slow_limits(name, 0.5), dt)


@cache
def with_six_joints() -> PlannedMotion:
    """The only way of arm7 with one joint frozen, without limits."""
    found = plan("arm7", machine("arm7").unlimited(), 0.01, frozen=(2,))
    assert isinstance(found, PlannedMotion)
    return found


def assert_promised(name: str, limits, found: PlannedMotion, dt: float) -> None:
    robot = machine(name)
    path = robot.line(WAYS[name], (0.1, -0.2, 0.15))
    law = Trapezoid.fastest(path.length, *SPEEDS[name])
    rows = np.vstack([robot.start, found.q])
    assert excess(rows, dt, *(limits.pair(kind) for kind in KINDS)).none
    s = np.array([demand.s for demand in found.demands])
    assert max(robot.errors(found.q, path.poses(s))) < 1e-9
    assert np.all(np.diff(s, prepend=0.0) >= 0.0)
    assert s[-1] == path.length
    assert len(s) * dt >= law.duration - 1e-6 * dt
    assert np.max(np.abs(np.diff(s, prepend=0.0)) / dt) <= law.speed * (1.0 + 1e-9)


def test_what_came_too_near_with_the_least_reserve_is_the_reason(monkeypatch) -> None:
    """Wider reserves may be refused for what they keep themselves: that is no reason to tell."""
    reserves = []
    near = TooNear(3, 0.0199, 0.02)

    def refused(model, task, grid, bounds, reserve):
        reserves.append(reserve)
        return Refusal(0.1, near=near) if len(reserves) < 3 else Refusal(0.2, reserve=reserve)

    monkeypatch.setattr(planned, "_with_reserve", refused)
    found = plan("arm7", slow_limits("arm7", 0.5), 0.01)
    assert found == Refusal(0.1, near=near)
    np.testing.assert_allclose(reserves, [1e-4, 4e-4, 1.6e-3])


@pytest.mark.parametrize(
    ("name", "dt"),
    first_rows(
        2,
        [
            ("arm7", 0.00025),
            ("arm7", 0.05),
            ("koch11", 0.001),
            ("arm7", 0.001),
            ("arm7", 0.01),
            ("koch11", 0.05),
        ],
    ),
)
def test_rows_of_a_slowed_motion_keep_every_promise(name: str, dt: float) -> None:
    limits = slow_limits(name, 0.5)
    found = slowed(name, dt)
    assert isinstance(found, PlannedMotion)
    assert found.timed.clock.duration > 1.02 * machine_law(name).duration
    assert_promised(name, limits, found, dt)


def machine_law(name: str) -> Trapezoid:
    return Trapezoid.fastest(machine(name).line(WAYS[name]).length, *SPEEDS[name])


@pytest.mark.parametrize("name", ["arm7"])
def test_ticks_change_the_duration_by_a_tick_only(name: str) -> None:
    times = [len(slowed(name, dt).q) * dt for dt in (0.00025, 0.01)]
    assert times[1] == pytest.approx(times[0], abs=0.012)


@robots
def test_without_limits_it_takes_the_programmed_time(name: str) -> None:
    found = plan(name, machine(name).unlimited(), 0.01)
    assert isinstance(found, PlannedMotion)
    assert found.timed.clock.duration == pytest.approx(machine_law(name).duration, rel=1e-6)
    assert_promised(name, machine(name).unlimited(), found, 0.01)


@robots
@pytest.mark.req("TRF-02")
def test_joints_that_may_not_move_count_as_frozen(name: str) -> None:
    """A speed of 0 both ways, or an acceleration of 0, keeps every bit of the joint."""
    spare = int(np.argmax(np.abs(np.linalg.svd(jacobian_at(machine(name), machine(name).start))[2][-1])))
    for kind in ("speed", "acceleration"):
        bound = np.where(np.arange(machine(name).n) == spare, 0.0, 2.0 * used(name).max() * 10.0)
        limits = machine(name).unlimited().with_pair(kind, -bound, bound)
        found = plan(name, limits, 0.01)
        assert isinstance(found, PlannedMotion), kind
        assert np.all(found.q[:, spare] == machine(name).start[spare])
        assert_promised(name, limits, found, 0.01)


@of_seven
def test_zero_on_one_side_of_a_joint_that_can_give_way(name: str) -> None:
    """The joint may rise or rest but never fall; the rest of the arm makes up for it."""
    robot = machine(name)
    spare = int(np.argmax(np.abs(np.linalg.svd(jacobian_at(robot, robot.start))[2][-1])))
    for side in (0, 1):
        speed = np.tile(3.0 * used(name).max() + 0.1, robot.n)
        lower, upper = -speed.copy(), speed.copy()
        (lower if side == 0 else upper)[spare] = 0.0
        limits = robot.unlimited().with_pair("speed", lower, upper)
        found = plan(name, limits, 0.01)
        assert isinstance(found, PlannedMotion), side
        assert_promised(name, limits, found, 0.01)


@of_seven
def test_a_clock_that_is_too_fast_is_slowed_by_the_check_of_its_rows(name: str, monkeypatch) -> None:
    """Reserves the wrong way round: the clock passes speeds by 2 %, accelerations by 5 %; no row may."""

    def too_fast(curve, limits, rates, acc):
        return clock_bounds(curve, limits, rates, acc, reserves=Reserves(-0.02, -0.05))

    limits = slow_limits(name, 0.5)
    plain = slowed(name, 0.01)
    monkeypatch.setattr(ladder, "clock_bounds", too_fast)
    found = plan(name, limits, 0.01)
    assert isinstance(found, PlannedMotion)
    assert isinstance(plain, PlannedMotion)
    assert found.timed.clock.duration < plain.timed.clock.duration
    assert found.factor > 1.005
    assert_promised(name, limits, found, 0.01)


# ---- refusals


@pytest.mark.req("MOT-22")
def test_a_position_limit_that_cuts_the_only_way_is_a_failed_step() -> None:
    """Six free joints of arm7 have one way; a limit across it leaves none."""
    robot = machine("arm7")
    free = with_six_joints()
    way = free.q[:, 0] - robot.start[0]
    cut = robot.start[0] + 0.5 * way[-1]
    lower, upper = np.full(7, -np.inf), np.full(7, np.inf)
    (upper if way[-1] > 0 else lower)[0] = cut
    found = plan("arm7", robot.unlimited().with_pair("position", lower, upper), 0.01, frozen=(2,))
    assert isinstance(found, Refusal)
    assert found.solution is not None
    assert not found.solution.solved
    s = np.array([demand.s for demand in free.demands])
    met = np.interp(0.5, way / way[-1], s)
    assert found.s == pytest.approx(met, abs=2e-3)


@pytest.mark.req("MOT-22")
def test_a_joint_that_cannot_accelerate_leaves_no_way_for_six() -> None:
    robot = machine("arm7")
    hard = np.where(np.arange(7) == 0, 0.0, 50.0)
    found = plan("arm7", robot.unlimited().with_pair("acceleration", -hard, hard), 0.01, frozen=(2,))
    assert isinstance(found, Refusal)
    assert found.solution is not None or found.broken is not None or found.timed is not None


@pytest.mark.req("MOT-22")
def test_a_joint_that_may_not_go_the_needed_way_stops_the_clock_or_the_walk() -> None:
    """Speed 0 on the one side that six joints need: no clock, however slow."""
    robot = machine("arm7")
    free = with_six_joints()
    lower, upper = np.full(7, -9.0), np.full(7, 9.0)
    (upper if free.q[-1, 0] > robot.start[0] else lower)[0] = 0.0
    found = plan("arm7", robot.unlimited().with_pair("speed", lower, upper), 0.01, frozen=(2,))
    assert isinstance(found, Refusal)
    assert found.timed is not None
    assert found.timed.clock.joint[found.knot] == 0
    assert found.timed.clock.governor[found.knot] == Governor.SPEED


@pytest.mark.req("MOT-22")
def test_a_merely_slow_limit_is_no_refusal() -> None:
    """A hundredth of the speed needed: a hundred times slower, and right."""
    robot = machine("arm7")
    slow = used("arm7") * np.where(np.arange(7) == 0, 0.05, 3.0)
    limits = robot.unlimited().with_pair("speed", -slow, slow)
    found = plan("arm7", limits, 0.01, frozen=(2,))
    assert isinstance(found, PlannedMotion)
    assert found.timed.clock.duration > 5.0 * machine_law("arm7").duration
    assert_promised("arm7", limits, found, 0.01)


# ---- the stages one by one


def first_motion(monkeypatch, answers: list[object]) -> tuple[object, list[object], list[bool]]:
    """What a task becomes whose curves end in these answers; the curves asked for, and the kinks told of."""
    robot = machine("arm7")
    path = robot.line((0.0, -0.02, 0.0))
    task = robot.task(path, Trapezoid.fastest(path.length, 0.25, 1.5), 0.01)
    clock = SimpleNamespace(duration=1.0, x=np.ones(3))
    known = [SimpleNamespace(clock=clock, number=number) for number in range(len(answers))]
    asked: list[object] = []
    kinks: list[bool] = []

    def timed_curves(*arguments, **_):
        kinks.append(arguments[-1])
        return iter(known)

    def rows_on_clock(model, timed, ticking, least):
        asked.append(timed.number)
        return answers[timed.number]

    monkeypatch.setattr(planned, "timed_curves", timed_curves)
    monkeypatch.setattr(planned, "rows_on_clock", rows_on_clock)
    monkeypatch.setattr(planned, "_standing", lambda *_: None)
    monkeypatch.setattr(planned, "_with_short_ends", lambda model, timed, *_: timed)
    return plan_motion(robot.model(robot.unlimited()), task), asked, kinks


def test_the_first_curve_whose_rows_keep_all_is_the_motion(monkeypatch) -> None:
    """Curves behind it are not asked for; those before it are refused. A walk has kinks."""
    made = PlannedMotion(None, None, None, 1.0)
    no = Refusal(0.1)
    assert first_motion(monkeypatch, [made, None, None]) == (made, [0], [True])
    assert first_motion(monkeypatch, [no, made, None]) == (made, [0, 1], [True])
    assert first_motion(monkeypatch, [no, no, Refusal(0.2)])[:2] == (Refusal(0.2), [0, 1, 2])


@pytest.mark.parametrize("at_once", [True, False])
def test_a_walk_has_kinks_and_postures_found_all_at_once_have_none(at_once: bool, monkeypatch) -> None:
    told: list[bool] = []

    def timed_curves(*arguments, **_):
        told.append(arguments[-1])
        return iter([])

    robot = machine("arm7")
    path = robot.line((0.0, -0.02, 0.0))
    task = robot.task(path, Trapezoid.fastest(path.length, 0.25, 1.5), 0.01)
    task = replace(task, ticking=replace(task.ticking, resolution=Resolution(8)))
    still = np.tile(robot.start, (41, 1))
    monkeypatch.setattr(planned, "_undisturbed", lambda *_: still if at_once else None)
    monkeypatch.setattr(planned, "elastic_walk", lambda *_: SimpleNamespace(stopped=None, q=still))
    monkeypatch.setattr(planned, "timed_curves", timed_curves)
    monkeypatch.setattr(planned, "_outside", lambda *_: Refusal(0.0))
    plan_motion(robot.model(robot.unlimited()), task)
    assert told == [not at_once]


@pytest.mark.parametrize("row", [None, 0, 4])
@pytest.mark.parametrize("ticks_a_row", [1, 2])
def test_rows_are_held_against_what_is_kept_clear_at_their_times(row: int | None, ticks_a_row: int) -> None:
    """From the start of the motion on; what comes too near is told with its row and its place on the path."""
    asked, near = [], TooNear(3, 0.0199, 0.02)

    def first_short(q, start, elapsed):
        asked.append((q, start, elapsed))
        return None if row is None else (row, near)

    robot, dt = machine("arm7"), 0.01
    path = robot.line((0.0, -0.02, 0.0))
    grid = path_grid(path, Trapezoid.fastest(path.length, 0.25, 1.5))
    rows = least_motion(robot, Poses(grid.poses.position[1:], grid.poses.rotation[1:]), robot.start)
    curve = JointCurve(grid.s, np.vstack([robot.start, rows]))
    clock = plan_clock(clock_bounds(curve, robot.unlimited(), grid.rates, 1.5))
    assert clock is not None
    task = robot.task(path, Trapezoid.fastest(path.length, 0.25, 1.5), dt)
    ticking = replace(task.ticking, resolution=Resolution(ticks_a_row))
    model = replace(robot.model(robot.unlimited()), clearance=SimpleNamespace(first_short=first_short))
    found = rows_on_clock(model, TimedCurve(curve, clock), ticking, 0.0)
    ((q, start, elapsed),) = asked
    ticks = int(np.ceil(clock.duration / dt - 1e-6))
    whole = ticks * dt
    assert np.array_equal(start, robot.start)
    np.testing.assert_allclose(elapsed, np.linspace(0.0, whole, len(q) + 1)[1:], rtol=1e-12)
    if row is None:
        assert isinstance(found, PlannedMotion)
        assert np.array_equal(found.q, q)
        return
    s, _ = clock.at(np.array([elapsed[row] * clock.duration / whole]))
    assert isinstance(found, Refusal)
    assert (found.near, found.tick) == (near, round(elapsed[row] / dt) - 1)
    assert found.s == pytest.approx(s[0], rel=1e-9)


def test_a_curve_that_swings_out_between_knots_is_told_by_the_side_and_the_tick(monkeypatch) -> None:
    """Every knot is on its limit or inside; between the first and the second one joint 1 passes it below."""
    robot, dt = machine("arm7"), 0.004
    path = robot.line((0.0, -0.02, 0.0))
    grid = path_grid(path, Trapezoid.fastest(path.length, 0.25, 1.5))
    q = np.tile(robot.start, (len(grid.s), 1))
    q[5:, 0] -= 0.1
    lower, upper = (side.copy() for side in robot.unlimited().pair("position"))
    lower[0], upper[0] = robot.start[0] - 0.1, robot.start[0]
    model = robot.model(robot.unlimited().with_pair("position", lower, upper))
    found = planned._outside(model, grid, q, dt)
    assert found.broken is not None
    assert grid.s[3] < found.s < grid.s[6]
    value, bound = found.broken.value, found.broken.bound
    assert (found.broken.joint, bound) in {(0, lower[0]), (0, upper[0])}
    assert value < lower[0] if bound == lower[0] else value > upper[0]
    assert found.broken.row == int(grid.times_at(np.array([found.s]))[0] / dt)
