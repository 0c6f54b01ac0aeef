"""A motion along a path: the tick walk where it keeps everything, a planned motion where it does not."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from flat_criterion import Flat
from irlx.blocks import LimitKind
from irlx.diagnostics import IrlxError
from irlx.motion.plan_path import PlannedPath
from irlx.motion.trapezoid import Trapezoid
from irlx.motion.whole_ticks import whole_ticks
from irlx.pacing import path_motion
from irlx.pacing.clock import programmed_clock
from irlx.pacing.demand import Demand
from irlx.pacing.path_motion import Failure, PacedPath, PathMotion, _walked, pace_path
from irlx.pacing.posture_term import PostureTerm
from irlx.pacing.slowdown.clock_bounds import Governor
from irlx.pacing.slowdown.planned import PlannedMotion, Refusal
from irlx.pacing.walk import Walk, walk
from irlx.transform.criteria.least_motion import LeastMotion
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.step_bounds import BoundSource, StepLimiter
from irlx.transform.tick import TickSolution, TickSolver, TickStatus
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


@cache
def slowed(name: str, dt: float) -> PacedPath | Failure:
    """The motion under limits that slow it down, once for all tests that look at it."""
    return paced(name, slow_limits(name, 0.5), dt)


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
    found = slowed(name, dt)
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
    found = slowed(name, 0.01)
    longer = 0.01 * (len(found.q) - motion_of(name, 0.01).plan.ticks)
    assert longer > 0.05
    assert sum(part.lost for part in found.slowings) == pytest.approx(longer, rel=1e-9)
    assert any(part.joint >= 0 and part.governor is not Governor.PROGRAM for part in found.slowings)


@of_seven
def test_the_joint_that_is_blamed_runs_at_its_limit(name: str) -> None:
    """Where the clock was slowed for a joint's speed, that joint is within 1 % of it in some row there."""
    limits = slow_limits(name, 0.5)
    found = slowed(name, 0.001)
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


def unsettled_motion(draws: bool = False) -> PathMotion:
    """A motion beside whose path a criterion hardly grows: the steps of its first tick go to and fro."""
    motion = motion_of("koch11", 0.1)
    flat = Flat(np.random.default_rng(UNSETTLED).normal(size=(6, 11)))
    return replace(motion, term=PostureTerm(lambda s, _: flat, draws))


UNSETTLED = 34


@pytest.mark.req("TRF-05")
def test_a_criterion_that_ticks_do_not_settle_on_is_held_back_and_costs_no_time(monkeypatch) -> None:
    """Bounds leave a way, so there is no reason to plan a slower motion."""
    monkeypatch.setattr(path_motion, "plan_motion", lambda *_: pytest.fail("a plan is asked for"))
    robot, motion = machine("koch11"), unsettled_motion()
    solver, model = TickSolver(robot.kinematics, ProxQpSolver()), robot.model(robot.unlimited())
    plain, _ = _walked(motion, model, solver, thorough=False)
    assert plain.halt is not None
    assert plain.halt.solution.status is TickStatus.NOT_CONVERGED
    found = pace_path(motion, model, solver)
    assert isinstance(found, PacedPath)
    assert (len(found.q), found.slowings, found.planned) == (motion.plan.ticks, (), False)
    poses = motion.plan.path.poses(found.demands.s)
    for q, position, rotation in zip(found.q, poses.position, poses.rotation, strict=True):
        reached = robot.kinematics.tool_pose(q)
        np.testing.assert_allclose(reached[1], position, rtol=0.0, atol=1e-8)
        np.testing.assert_allclose(reached[0], rotation, rtol=0.0, atol=1e-8)
    # The rows are those of the term that is told, which a stopped run goes on with.
    again, _ = _walked(replace(motion, term=found.term), model, solver, thorough=False)
    np.testing.assert_array_equal(found.q, again.q)


@pytest.mark.parametrize("bound", [BoundSource.SPEED, BoundSource.ACCELERATION])
@pytest.mark.parametrize("later", [0, 1, None], ids=["as fast", "slower", "refused"])
def test_a_walk_that_jumps_onto_a_bound_gives_way_to_a_plan_as_fast(monkeypatch, bound, later) -> None:
    """A jump to another minimum is kept by acceleration bounds, and what is planned needs none."""
    motion = unsettled_motion()
    jumping = PacedPath(np.zeros((9, 11)), np.full((9, 11), 1 + bound, np.int8), (), 0, motion.term)
    plan = Refusal(0.1) if later is None else object.__new__(PlannedMotion)
    if isinstance(plan, PlannedMotion):
        object.__setattr__(plan, "q", np.zeros((9 + later, 11)))
    monkeypatch.setattr(path_motion, "_walked_held_back", lambda *_: jumping)
    monkeypatch.setattr(path_motion, "plan_motion", lambda *_: plan)
    monkeypatch.setattr(path_motion, "_planned", lambda *_: "planned")
    robot = machine("koch11")
    solver = TickSolver(robot.kinematics, ProxQpSolver())
    found = path_motion._paced(motion, robot.model(robot.unlimited()), solver)
    assert found == "planned" if later == 0 else found is jumping


def test_what_draws_the_joints_is_planned_before_it_is_held_back(monkeypatch) -> None:
    """Held back it would not draw them as far."""
    asked = []
    monkeypatch.setattr(path_motion, "plan_motion", lambda *_: asked.append("plan") or found)
    monkeypatch.setattr(path_motion, "_planned", lambda *_: "planned")
    found = object.__new__(PlannedMotion)
    robot = machine("koch11")
    solver = TickSolver(robot.kinematics, ProxQpSolver())
    assert path_motion._paced(unsettled_motion(True), robot.model(robot.unlimited()), solver) == "planned"
    assert asked == ["plan"]


class HeldPlans:
    """What becomes of a motion without a way whose plan ended at a tick of some status."""

    def __init__(self, monkeypatch, status: TickStatus, plan: object, walks: bool) -> None:
        nothing = np.empty((0, 7)), np.empty((0, 7), np.int8)
        self.status, self.plan, self.asked = status, plan, list[str]()
        self.walk = Walk(*nothing, (), 5, None if walks else "found"), None
        monkeypatch.setattr(path_motion, "_paced", lambda *_: self.failure())
        monkeypatch.setattr(path_motion, "_walked", lambda *_, **__: self.asked.append("walk") or self.walk)
        monkeypatch.setattr(path_motion, "plan_motion", self._plan_motion)
        monkeypatch.setattr(path_motion, "_planned", lambda *_: "planned")

    def failure(self) -> Failure:
        left = TickSolution(self.status, np.zeros(7), np.zeros(7, np.int8), np.zeros(6), 30)
        return Failure(None, None, Refusal(0.1, solution=left))

    def restraining(self) -> None:
        return None

    def _plan_motion(self, *_: object) -> object:
        self.asked.append("plan")
        if isinstance(self.plan, IrlxError):
            raise self.plan
        return self.plan


def test_a_plan_that_does_not_settle_is_made_once_more_with_its_criterion_held_back(monkeypatch) -> None:
    plan = object.__new__(PlannedMotion)
    held = HeldPlans(monkeypatch, TickStatus.NOT_CONVERGED, plan, True)
    assert pace_path(motion_of("arm7", 0.01), None, held) == "planned"
    assert held.asked == ["plan"]


@pytest.mark.parametrize("walks", [False, True])
@pytest.mark.parametrize("plan", [Refusal(0.2), IrlxError([])], ids=["refused", "too long"])
def test_where_that_plan_is_none_either_the_last_walk_decides(monkeypatch, plan, walks: bool) -> None:
    """Its place is told: without its criterion held back the motion did not come as far."""
    held = HeldPlans(monkeypatch, TickStatus.NOT_CONVERGED, plan, walks)
    found = pace_path(motion_of("arm7", 0.01), None, held)
    assert held.asked == ["plan", "walk"]
    if walks:
        assert found.iterations == 5
    else:
        assert found.refusal.s == (0.2 if isinstance(plan, Refusal) else 0.1)


def test_bounds_that_leave_no_way_are_not_tried_with_less_of_the_criterion(monkeypatch) -> None:
    held = HeldPlans(monkeypatch, TickStatus.NO_STEP, None, False)
    assert isinstance(pace_path(motion_of("arm7", 0.01), None, held), Failure)
    assert held.asked == ["walk"]
