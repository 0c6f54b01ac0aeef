"""A walk that runs ahead gives the very rows of one that looks at each tick by itself."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest

from irlx.motion.trapezoid import Trapezoid
from irlx.motion.whole_ticks import whole_ticks
from irlx.pacing.clock import programmed_clock
from irlx.pacing.demand import Demands, demands
from irlx.pacing.walk import _AHEAD, _LEAST_AHEAD, _LONGEST_WAIT, Walk, _Haste, walk
from irlx.robot.limits import JointLimits
from irlx.scene.distances import Distances
from irlx.scene.obstacle import Obstacle
from irlx.scene.watched_pair import watched_pairs
from irlx.solids.placement import Placement
from irlx.solids.shape import Solid, Sphere
from irlx.transform.clearance import Clearance
from irlx.transform.criteria.least_motion import LeastMotion
from irlx.transform.criteria.posture import Posture
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.step_bounds import StepLimiter
from irlx.transform.tick import TickSolver
from long_run import first
from machines import machine
from slow_cases import SPEEDS, WAYS

DT = 0.004
NAMES = ("arm7", "koch11")
KINDS = 7
"""Cases of a machine."""
BESIDE = 0.12
"""Way (m) from the tool to the middle of a ball of 50 mm, whose influence reaches 60 mm."""
pytestmark = [pytest.mark.req("MOT-20"), pytest.mark.req("TRF-10")]


class TickByTick(TickSolver):
    """Looks at every tick by itself."""

    runs_free = False


@dataclass(frozen=True)
class Case:
    """A line of a machine: its demands, limits and criterion, joints that are frozen, what is kept clear."""

    name: str
    limits: JointLimits
    draws: bool = False
    frozen: tuple[int, ...] = ()
    ball: tuple[float, float, float] | None = None

    def demands(self) -> Demands:
        path = machine(self.name).line(WAYS[self.name], (0.1, -0.2, 0.15))
        law = Trapezoid.fastest(path.length, *SPEEDS[self.name])
        ticks = whole_ticks(law.duration, DT)
        return demands(path, programmed_clock(law.stretched(ticks * DT), ticks, DT), 1)

    def clearance(self, kinematics) -> Clearance | None:
        if self.ball is None:
            return None
        ball = Obstacle("ball", (Solid(Sphere(0.05)),), Placement(self.ball), 0.005, 0.06)
        return Clearance(Distances(kinematics, watched_pairs(kinematics, [ball], None)))

    def walk(self, solver=TickSolver, asked: Demands | None = None) -> Walk:
        robot = machine(self.name)
        kinematics, free = robot.kinematics, np.ones(robot.n, dtype=bool)
        free[list(self.frozen)] = False
        away = robot.start + 0.2
        criterion = Posture(robot.weights, away) if self.draws else LeastMotion(robot.weights)
        ticks = solver(kinematics, ProxQpSolver())
        asked = self.demands() if asked is None else asked
        limiter, clear = StepLimiter(self.limits, DT), self.clearance(kinematics)
        return walk(ticks, limiter, lambda _: criterion, free, robot.start, asked, False, clear)


@cache
def used(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Rows of the walk without limits, and the largest speeds of its joints."""
    q = Case(name, machine(name).unlimited()).walk(TickByTick).q
    return q, np.max(np.abs(np.diff(q, axis=0)), axis=0) / DT


@cache
def cases() -> list[Case]:
    found = []
    for name in NAMES:
        free = machine(name).unlimited()
        q, fastest = used(name)
        joint = int(np.argmax(fastest))
        found += [Case(name, free), Case(name, free, draws=True), Case(name, free, frozen=(2,))]
        # A limit that the way passes in its middle: of speed, and of the position half way.
        half = np.where(np.arange(len(fastest)) == joint, 0.9 * fastest, 10.0)
        found.append(Case(name, free.with_pair("speed", -half, half)))
        lower, upper = (side.copy() for side in free.pair("position"))
        rising = q[-1, joint] > q[0, joint]
        (upper if rising else lower)[joint] = np.mean(q[len(q) // 2 : len(q) // 2 + 2, joint])
        found.append(Case(name, free.with_pair("position", lower, upper)))
        accelerations = np.full(len(fastest), 40.0)
        found.append(
            Case(
                name,
                free.with_pair("position", lower, upper)
                .with_pair("speed", -2.0 * fastest - 0.1, 2.0 * fastest + 0.1)
                .with_pair("acceleration", -accelerations, accelerations),
            )
        )
        # One that stands still: no step of it is allowed at all.
        still = np.where(np.arange(len(fastest)) == joint, 0.0, 10.0)
        found.append(Case(name, free.with_pair("speed", -still, still)))
    assert len(found) == KINDS * len(NAMES)
    return found


@cache
def ahead_of(number: int) -> Walk:
    """The walk of a case that runs ahead."""
    return cases()[number].walk()


@pytest.mark.parametrize("number", first(KINDS + 3, range(len(NAMES) * KINDS)))
def test_rows_are_the_very_ones_of_single_ticks(number: int) -> None:
    ahead, singly = ahead_of(number), cases()[number].walk(TickByTick)
    assert np.all(ahead.active == singly.active)
    # Ticks that begin outside their bounds take other steps, which lead to the same but for rounding.
    np.testing.assert_allclose(ahead.q, singly.q, rtol=0, atol=1e-13 if np.any(singly.active) else 0.0)
    assert len(ahead.demands) == len(singly.demands)
    assert (ahead.halt is None) == (singly.halt is None)
    if ahead.halt is not None and singly.halt is not None:
        assert ahead.halt.demand.tick == singly.halt.demand.tick
        assert ahead.halt.solution.status is singly.halt.solution.status
    elif not np.any(singly.active):
        assert ahead.iterations == singly.iterations


@pytest.mark.parametrize("name", first(1, NAMES))
def test_a_limit_that_a_row_meets_to_the_last_bit_is_kept(name: str) -> None:
    """Whether such a row was held is a matter of rounding: then the others are the same but for that."""
    q, _ = used(name)
    joint = int(np.argmax(np.abs(q[-1] - q[0])))
    lower, upper = (side.copy() for side in machine(name).unlimited().pair("position"))
    (upper if q[-1, joint] > q[0, joint] else lower)[joint] = q[len(q) // 2, joint]
    case = Case(name, machine(name).unlimited().with_pair("position", lower, upper))
    ahead, singly = case.walk(), case.walk(TickByTick)
    assert np.all((ahead.q >= lower) & (ahead.q <= upper))
    assert np.any(ahead.q[:, joint] == q[len(q) // 2, joint])
    np.testing.assert_allclose(ahead.q, singly.q, rtol=0, atol=1e-12)


@pytest.mark.parametrize("name", first(1, NAMES))
def test_bounds_bite_in_these_cases(name: str) -> None:
    """Of the cases at least two have joints held in the middle of the way, and go on behind that."""
    walks = [ahead_of(number) for number, case in enumerate(cases()) if case.name == name]
    held = [np.any(found.active, axis=1) for found in walks if found.halt is None]
    assert sum(bool(np.any(rows[2:-2]) and not np.all(rows)) for rows in held) >= 2


@pytest.mark.req("TRF-13")
@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_what_comes_near_on_the_way_is_looked_at_where_it_does(share: float) -> None:
    """A ball beside the tool's way: far at first and at last, within its influence between."""
    name = "arm7"
    robot, plain = machine(name), Case(name, machine(name).unlimited())
    q = plain.walk().q
    position, _ = robot.pose(q[int(share * (len(q) - 1))])
    beside = position + np.array([BESIDE, 0.0, 0.0])
    case = Case(name, robot.unlimited(), ball=tuple(beside.tolist()))
    ahead, singly = case.walk(), case.walk(TickByTick)
    assert np.all(ahead.q == singly.q)
    assert ahead.closest == singly.closest
    assert ahead.closest is not None
    near = [one is not None for one in ahead.closest]
    assert any(near)
    assert not all(near)
    assert ahead.halt is None


def test_who_watches_is_told_ticks_in_order() -> None:
    case, told = Case("arm7", machine("arm7").unlimited()), list[int]()
    robot, asked = machine("arm7"), case.demands()
    solver, least = TickSolver(robot.kinematics, ProxQpSolver()), LeastMotion(robot.weights)
    free, limiter = np.ones(7, dtype=bool), StepLimiter(case.limits, DT)
    walk(solver, limiter, lambda _: least, free, robot.start, asked, ticked=told.append)
    assert told == sorted(told)
    assert told[0] == 1
    assert 2 <= len(told) < len(asked) / 4
    assert max(np.diff(told)) <= 130


def test_a_demand_out_of_reach_ends_a_walk_at_its_tick() -> None:
    case = Case("arm7", machine("arm7").unlimited())
    asked = case.demands()
    far = asked.position.copy()
    far[60:] += 5.0
    torn = Demands(asked.tick, asked.s, far, asked.rotation, asked.twist)
    found = case.walk(asked=torn)
    assert found.halt is not None
    assert found.halt.demand.tick == 61
    assert len(found.q) == len(found.demands) == 60
    assert np.all(found.q == case.walk().q[:60])


def test_a_walk_runs_farther_ahead_as_long_as_all_ticks_are_done() -> None:
    haste, tried = _Haste(True), []
    for _ in range(8):
        tried.append(haste.ahead)
        haste.went(haste.ahead)
    assert tried == [min(_LEAST_AHEAD * 2**k, _AHEAD) for k in range(8)]
    haste.went(_AHEAD - 1)
    assert haste.ahead == _LEAST_AHEAD


def test_a_walk_waits_twice_as_long_after_each_try_in_vain() -> None:
    haste, waits = _Haste(True), []
    for _ in range(9):
        assert haste.ahead == _LEAST_AHEAD
        haste.went(0)
        waits.append(0)
        while haste.ahead == 0:
            haste.went(0)
            waits[-1] += 1
    assert waits == [min(2**k, _LONGEST_WAIT) for k in range(9)]
    haste.went(_LEAST_AHEAD)
    haste.went(0)
    haste.went(0)
    assert haste.ahead == _LEAST_AHEAD


def test_a_walk_that_is_not_able_to_never_runs_ahead() -> None:
    haste = _Haste(False)
    for _ in range(5):
        assert haste.ahead == 0
        haste.went(0)
