"""Where a posture goes that comes too near: the least step that wins what lacks, the tool where it is."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pinocchio as pin
import pytest
from scipy.linalg import null_space

from drawn_scenes import cell_of
from irlx.pacing.correction.approach import TOO_NEAR
from irlx.pacing.correction.corrected_tick import (
    Corrected,
    Surroundings,
    _Tick,
    corrected_tick,
    stepped,
    uncorrected,
)
from irlx.pacing.correction.giving_way import LONGEST, retreat_of
from irlx.pacing.correction.offset_limiter import OffsetLimiter
from irlx.pacing.correction.plan import PlannedRow
from irlx.pacing.correction.tool_rates import ToolRates
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.scene.distances import Distances
from irlx.scene.obstacle import Obstacle
from irlx.scene.watched_pair import watched_pairs
from irlx.solids.placement import Placement
from irlx.solids.shape import Solid, Sphere
from irlx.transform.clearance import Clearance
from irlx.transform.criteria.posture import Posture
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.step_bounds import StepBounds
from irlx.transform.tick import TickSolver
from irlx.transform.tick_problem import TickProblem

DT = 0.05
WEIGHTS = np.array([3.0, 1.0, 2.0, 1.0, 0.5, 1.0, 1.0])
NOWHERE = np.full(7, np.inf)
EVERYWHERE = StepBounds(-NOWHERE, NOWHERE)


class BesideBall(NamedTuple):
    """An arm whose elbow is a little outside the margin of a ball; `base` (7,) leads it inside."""

    q: np.ndarray
    base: np.ndarray
    kinematics: Kinematics
    clearance: Clearance

    def problem(self) -> TickProblem:
        keeping = self.clearance.following_tick(self.q, self.base, DT)
        keeping.kept(self.base)
        rotation, position = self.kinematics.tool_pose(self.q + self.base)
        posture = Posture(WEIGHTS, self.q)
        return TickProblem(
            pin.SE3(rotation, position), self.q, EVERYWHERE, posture, np.ones(7, dtype=bool), keeping
        )

    def least(self, q: np.ndarray) -> float:
        distances = self.clearance.distances
        return float(np.min(distances.of(q, np.arange(len(distances.pairs))).distance))


def beside_ball(way: float) -> BesideBall:
    """The ball stands where the elbow swings to; the arm swings towards it by `way` rad in all."""
    cell, kinematics = cell_of("arm7")
    start = cell.start
    rotation, position = kinematics.tool_pose(start)
    _, jacobian = kinematics.difference(start, pin.SE3(rotation, position))
    swing = np.linalg.svd(jacobian)[2][-1]
    elbows = []
    for q in (start, start + 1e-4 * swing):
        pin.forwardKinematics(kinematics.model, kinematics.data, q)
        elbows.append(kinematics.data.oMi[4].translation.copy())
    aside = elbows[1] - elbows[0]
    place = Placement(tuple((elbows[0] + 0.18 * aside / np.linalg.norm(aside)).tolist()))

    def clearance(margin: float) -> Clearance:
        ball = Obstacle("ball", (Solid(Sphere(0.05)),), place, margin, margin + 0.3)
        found = Clearance(Distances(kinematics, watched_pairs(kinematics, [ball], None)))
        return found.beginning(0.0)

    gap = clearance(0.0).nearest(start, start)
    assert gap is not None
    beside = BesideBall(start, way * swing, kinematics, clearance(gap.distance - 1e-3))
    assert beside.least(start + beside.base) < gap.distance - 3e-3
    return beside


def test_nothing_is_near() -> None:
    beside = beside_ball(0.05)
    problem = beside.problem()._replace(clearance=None)
    found = retreat_of(problem, beside.kinematics, WEIGHTS, beside.base)
    assert len(found.pairs) == 0
    assert not np.any(found.step)


def test_the_least_step_that_wins_what_lacks_and_leaves_the_tool() -> None:
    """Brute force: among the steps with J d = 0 the one that G d = lack asks for, least by the weights."""
    beside = beside_ball(0.05)
    problem = beside.problem()
    found = retreat_of(problem, beside.kinematics, WEIGHTS, beside.base)
    rows = problem.clearance.rows(beside.base)
    short = rows.lower > 0.0
    assert np.any(short)
    np.testing.assert_array_equal(found.pairs, problem.clearance.near.pairs[short])
    _, jacobian = beside.kinematics.difference(beside.q + beside.base, problem.target)
    root = np.sqrt(WEIGHTS)
    still = null_space(jacobian / root)
    along = np.linalg.lstsq(rows.matrix[short] / root @ still, rows.lower[short], rcond=1e-10)[0]
    best = still @ along / root
    np.testing.assert_allclose(jacobian @ best, 0.0, rtol=0, atol=1e-12)
    assert 1e-4 < np.max(np.abs(best)) < LONGEST
    np.testing.assert_allclose(found.step, best, rtol=0, atol=1e-9)


def test_it_is_no_longer_than_directions_hold() -> None:
    near, far = beside_ball(0.05), beside_ball(0.6)
    short, long = (retreat_of(one.problem(), one.kinematics, WEIGHTS, one.base).step for one in (near, far))
    assert 0.0 < np.max(np.abs(short)) < LONGEST
    assert np.max(np.abs(long)) == pytest.approx(LONGEST, rel=1e-12)


def planned(beside: BesideBall, q: np.ndarray) -> PlannedRow:
    rotation, position = beside.kinematics.tool_pose(q)
    ends = np.minimum(beside.q, beside.q + beside.base), np.maximum(beside.q, beside.q + beside.base)
    return PlannedRow(q, rotation, position, *ends, None)


def around(beside: BesideBall, limits: JointLimits, clearance: Clearance | None) -> Surroundings:
    solver = TickSolver(beside.kinematics, ProxQpSolver())
    free, rates = np.ones(7, dtype=bool), ToolRates(0.4, 2.0, 0.3, 1.5)
    return Surroundings(solver, WEIGHTS, free, OffsetLimiter(limits, DT), rates, clearance)


def wide(speed: float = 9.0) -> JointLimits:
    return JointLimits(
        *(side for half in (6.0, speed, 400.0) for side in (np.full(7, -half), np.full(7, half)))
    )


def test_a_posture_gives_way_by_that_step() -> None:
    """The plan leads the elbow inside the margin: the posture is that much beside it, and farther off."""
    beside = beside_ball(0.05)
    before, row = uncorrected(planned(beside, beside.q)), planned(beside, beside.q + beside.base)
    keeping = beside.clearance.following_tick(beside.q, beside.base, DT)
    surroundings = around(beside, wide(), beside.clearance)
    tick = _Tick(before, row, EVERYWHERE, Posture(WEIGHTS, row.q), surroundings, keeping)
    found = tick._giving_way(np.zeros(6), None)
    assert found is not None
    wanted = retreat_of(beside.problem(), beside.kinematics, WEIGHTS, beside.base).step
    np.testing.assert_allclose(found.q - row.q, wanted, rtol=0, atol=5.0 * np.max(np.abs(wanted)) ** 2)
    assert beside.least(found.q) > beside.least(row.q) + 1e-3
    for mine, its in zip(beside.kinematics.tool_pose(found.q), (row.rotation, row.position), strict=True):
        np.testing.assert_allclose(mine, its, rtol=0, atol=1e-8)


@pytest.mark.parametrize(("request_y", "governor"), [(0.0, None), (0.004, TOO_NEAR)])
def test_it_gives_way_where_the_correction_has_stood_and_stands(request_y: float, governor) -> None:
    """What kept it from its request is told, where there is one."""
    beside = beside_ball(0.05)
    before, row = uncorrected(planned(beside, beside.q)), planned(beside, beside.q + beside.base)
    surroundings, nothing = around(beside, wide(), beside.clearance), np.zeros(6)

    def tick() -> _Tick:
        keeping = beside.clearance.following_tick(beside.q, beside.base, DT)
        return _Tick(before, row, EVERYWHERE, Posture(WEIGHTS, row.q), surroundings, keeping)

    found = tick().pressed(nothing, nothing, np.array([0.0, request_y, 0.0, 0.0, 0.0, 0.0]))
    assert found is not None
    np.testing.assert_array_equal(found.q, tick()._giving_way(nothing, governor).q)
    assert not np.any(found.correction)
    assert found.governor == governor
    assert found.refused is (governor is not None)


def test_where_no_posture_gives_way_the_correction_goes_on(monkeypatch) -> None:
    """The limits first, then the pose, then what must stay clear: as though nothing were near."""
    beside = beside_ball(0.05)
    before, row = uncorrected(planned(beside, beside.q)), planned(beside, beside.q + beside.base)
    request = np.array([0.0, 0.004, 0.0, 0.0, 0.0, 0.0])
    monkeypatch.setattr(_Tick, "pressed", lambda *_: None)
    found = corrected_tick(before, row, request, around(beside, wide(), beside.clearance))
    alone = corrected_tick(before, row, request, around(beside, wide(), None))
    np.testing.assert_array_equal(found.q, alone.q)
    np.testing.assert_array_equal(found.correction, alone.correction)
    assert found.governor == alone.governor


def test_an_offset_that_stands_goes_along_with_the_plan() -> None:
    """Of a joint that makes no step the posture is plan and offset; where nothing moves, to the bit."""
    beside = beside_ball(0.05)
    offset = 0.1 * np.sin(np.arange(7.0) + 1.0)
    row = planned(beside, beside.q)
    before = Corrected(row, beside.q + offset, np.zeros(7), np.zeros(6), np.zeros(6), bent=True)
    surroundings = around(beside, wide(), None)
    still = stepped(before, row, np.zeros(7), surroundings)
    assert still.q.tobytes() == before.q.tobytes()
    moved = stepped(before, planned(beside, beside.q + beside.base), np.zeros(7), surroundings)
    np.testing.assert_allclose(moved.q, beside.q + beside.base + offset, rtol=0, atol=1e-15)
    assert not np.any(moved.speed)
