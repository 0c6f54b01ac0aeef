"""A motion along a path: the tick walk where it keeps everything, a planned motion where it does not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from irlx.blocks import LimitKind
from irlx.motion.plan_path import PlannedPath
from irlx.motion.trapezoid import Trapezoid
from irlx.motion.whole_ticks import whole_ticks
from irlx.pacing import path_motion
from irlx.pacing.clock import programmed_clock
from irlx.pacing.demand import Demand
from irlx.pacing.path_motion import Failure, PacedPath, PathMotion, _walked, pace_path
from irlx.pacing.posture_term import PostureTerm
from irlx.pacing.slowdown.clock_bounds import Governor
from irlx.pacing.slowdown.planned import Refusal
from irlx.pacing.walk import Walk, walk
from irlx.transform.criteria.least_motion import LeastMotion
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.step_bounds import StepLimiter
from irlx.transform.tick import TickSolver
from long_run import first, first_rows
from machines import machine
from slow_cases import SPEEDS, WAYS, slow_limits, used
from stream_judge import excess

pytestmark = [pytest.mark.req("MOT-20"), pytest.mark.req("MOT-21")]

robots = pytest.mark.parametrize("name", ["arm7", "koch11"])
of_seven = pytest.mark.parametrize("name", first(1, ["arm7", "koch11"]))
KINDS = ("position", "speed", "acceleration")


def motion_of(name: str, dt: float) -> PathMotion:
    robot = machine(name)
    path = robot.line(WAYS[name], (0.1, -0.2, 0.15))
    law = Trapezoid.fastest(path.length, *SPEEDS[name])
    ticks = whole_ticks(law.duration, dt)
    plan = PlannedPath(path, law.stretched(ticks * dt), ticks, law)
    least = LeastMotion(robot.weights)
    return PathMotion(
        plan, robot.start, PostureTerm(lambda s, _: least, False), dt, 1, lambda t: whole_ticks(t, dt)
    )


def paced(name: str, limits, dt: float = 0.01, frozen: tuple[int, ...] = ()) -> PacedPath | Failure:
    robot = machine(name)
    solver = TickSolver(robot.kinematics, ProxQpSolver())
    return pace_path(motion_of(name, dt), robot.model(limits, frozen), solver)


@robots
@pytest.mark.parametrize("wide", [False, True])
def test_undisturbed_motions_are_the_very_rows_of_the_walk(name: str, wide: bool) -> None:
    robot, dt = machine(name), 0.01
    fast = 1.3 * used(name) + 0.1
    limits = robot.unlimited().with_pair("speed", -fast, fast) if wide else robot.unlimited()
    found = paced(name, limits)
    assert isinstance(found, PacedPath)
    assert not found.planned
    assert found.slowings == ()
    motion = motion_of(name, dt)
    least = LeastMotion(robot.weights)
    clock = programmed_clock(motion.plan.law, motion.plan.ticks, dt)
    solver = TickSolver(robot.kinematics, ProxQpSolver())
    free = np.ones(robot.n, dtype=bool)
    demanded = motion.demands_of(clock)
    wanted = walk(solver, StepLimiter(limits, dt), lambda d: least, free, robot.start, demanded)
    assert np.all(found.q == wanted.q)
    assert len(found.q) == motion.plan.ticks


@pytest.mark.parametrize(
    ("name", "dt"), first_rows(2, [("arm7", 0.001), ("koch11", 0.01), ("arm7", 0.01), ("koch11", 0.001)])
)
def test_disturbed_motions_are_planned_and_keep_every_promise(name: str, dt: float) -> None:
    limits = slow_limits(name, 0.5)
    found = paced(name, limits, dt)
    assert isinstance(found, PacedPath)
    assert found.planned
    assert found.iterations == 0
    rows = np.vstack([machine(name).start, found.q])
    assert excess(rows, dt, *(limits.pair(kind) for kind in KINDS)).none
    path = motion_of(name, dt).plan.path
    s = np.array([demand.s for demand in found.demands])
    assert max(machine(name).errors(found.q, path.poses(s))) < 1e-9
    assert np.all(np.diff(s) >= 0.0)
    assert [demand.tick for demand in found.demands] == list(range(1, len(s) + 1))


@of_seven
def test_what_is_lost_is_what_the_motion_takes_longer(name: str) -> None:
    found = paced(name, slow_limits(name, 0.5))
    longer = len(found.q) * 0.01 - motion_of(name, 0.01).plan.programmed.duration
    assert sum(part.lost for part in found.slowings) == pytest.approx(longer, abs=0.01 + 0.01 * longer)
    assert any(part.joint >= 0 and part.governor is not Governor.PROGRAM for part in found.slowings)


@of_seven
def test_the_joint_that_is_blamed_runs_at_its_limit(name: str) -> None:
    """Where the clock was slowed for a joint's speed, that joint is within 1 % of it in some row there."""
    limits = slow_limits(name, 0.5)
    found = paced(name, limits, 0.001)
    speeds = np.diff(np.vstack([machine(name).start, found.q]), axis=0) / 0.001
    fast = [part for part in found.slowings if part.governor is Governor.SPEED and part.joint >= 0]
    assert fast
    for part in fast:
        share = np.abs(speeds) / limits.speed_upper
        assert share[part.first_row : part.last_row + 1, part.joint].max() > 0.99, part


@pytest.mark.req("MOT-22")
def test_a_motion_without_a_way_is_a_failure_with_both_reasons() -> None:
    robot = machine("arm7")
    way = paced("arm7", robot.unlimited(), frozen=(2,)).q[:, 0] - robot.start[0]
    bound = np.full(7, np.inf)
    bound[0] = robot.start[0] + 0.5 * way[-1]
    sides = (
        (-np.full(7, np.inf), bound)
        if way[-1] > 0
        else (bound * np.where(np.arange(7) == 0, 1, -1), np.full(7, np.inf))
    )
    found = paced("arm7", robot.unlimited().with_pair("position", *sides), frozen=(2,))
    assert isinstance(found, Failure)
    assert found.halt is not None
    assert found.refusal.solution is not None
    assert found.halt.demand.s == pytest.approx(found.refusal.s, abs=5e-3)


@pytest.mark.parametrize("pushed", [False, True])
def test_the_stop_of_a_walk_is_judged_too(pushed: bool) -> None:
    """Demands that run away faster and faster can be met tick by tick, but nobody stops in the last one."""
    dt = 0.01

    def push(demand: Demand) -> Demand:
        time = dt * demand.tick
        return demand._replace(position=demand.position + np.array([0.0, 0.0, -0.25 * time**2]))

    robot, motion = machine("arm7"), motion_of("arm7", dt)
    if pushed:
        motion = replace(motion, modifiers=(push,))
    most = np.full(robot.n, 40.0)
    model = robot.model(robot.unlimited().with_pair("acceleration", -most, most))
    walked, broken = _walked(motion, model, TickSolver(robot.kinematics, ProxQpSolver()), thorough=False)
    assert walked.halt is None
    assert (broken is not None) is pushed
    if broken is not None:
        assert (broken.kind, broken.row) == (LimitKind.ACCELERATION, len(walked.q))


class Ways:
    """A motion whose terms and whose last walk have a way or have none, as told; `asked` in their order."""

    def __init__(self, monkeypatch, terms: dict[str, bool], last: tuple[bool, bool]) -> None:
        motion = motion_of("arm7", 0.01)
        other = replace(motion.term) if "second" in terms else None
        self.motion, self.asked = replace(motion, term=replace(motion.term, otherwise=other)), list[str]()
        nothing = np.empty((0, 7)), np.empty((0, 7), np.int8)
        self.found = {
            term: PacedPath(*nothing, (), 0, motion.term) if works else Failure(None, None, Refusal(0.1))
            for term, works in terms.items()
        }
        halt, broken = (None if done else "found" for done in last)
        self.walk = Walk(*nothing, (), 5, halt), broken
        monkeypatch.setattr(path_motion, "_paced", self._paced)
        monkeypatch.setattr(path_motion, "_walked", self._walked)

    def restraining(self) -> str:
        return "restraining solver"

    def _paced(self, given: PathMotion, *_) -> PacedPath | Failure:
        self.asked.append("first" if given.term is self.motion.term else "second")
        return self.found[self.asked[-1]]

    def _walked(self, given: PathMotion, model, solver, thorough: bool):
        assert (given, solver, thorough) == (self.motion, "restraining solver", True)
        self.asked.append("walk")
        return self.walk


@pytest.mark.parametrize("first", [False, True])
@pytest.mark.parametrize("second", [None, False, True])
def test_another_posture_term_serves_where_the_first_one_fails(monkeypatch, first, second) -> None:
    """A way is a way; of failures the first one is told, which is of what was asked for."""
    terms = {"first": first} | ({} if second is None else {"second": second})
    ways = Ways(monkeypatch, terms, (False, True))
    chosen = pace_path(ways.motion, None, ways)
    assert chosen is ways.found["second" if second and not first else "first"]
    tried = ["first"] if first or second is None else ["first", "second"]
    assert ways.asked == tried + ([] if first or second else ["walk"])


@pytest.mark.parametrize("last", [(True, True), (True, False), (False, True)])
def test_the_last_resort_is_a_walk_that_holds_its_criterion_back(monkeypatch, last) -> None:
    """It counts where every tick is done and no row breaks a bound."""
    ways = Ways(monkeypatch, {"first": False}, last)
    chosen = pace_path(ways.motion, None, ways)
    assert ways.asked == ["first", "walk"]
    assert isinstance(chosen, PacedPath if all(last) else Failure)
    assert chosen is ways.found["first"] or chosen.iterations == 5
