"""What the report of obstacles counts, and a correction that an obstacle stands in the way of."""

from __future__ import annotations

import numpy as np
import pytest

from drawn_scenes import cell_of
from irlx.blocks import MotionLaw, MoveBlock, MoveKind, ObstacleBlock, Origin, PoseTarget
from irlx.diagnostics import Place
from irlx.pacing.correction.corrector import Corrector, Senses
from irlx.pacing.correction.nearness import Nearness, ObstacleReport
from irlx.pacing.correction.share import CORRECTION_SHARE
from irlx.pacing.correction.tally import Tally
from irlx.pacing.correction.tool_rates import ToolRates
from irlx.pacing.executed import Executed
from irlx.pacing.pacer import Pacer
from irlx.pacing.situation import PacingSetup
from irlx.scene.obstacle import Obstacle
from irlx.scene.scene import Scene
from irlx.solids.placement import Placement
from irlx.solids.shape import Solid, Sphere

DT, MARGIN, RADIUS = 0.05, 0.02, 0.05
PLACE = Place("t.irl")
BESIDE = (0.18, 0.0, 0.0)
"""From the tool, m: eleven centimetres of air between the ball and the arm."""


def pacer_beside(away, margin: float = MARGIN) -> tuple[Pacer, np.ndarray]:
    """An arm with a ball at `away` (3,) m from its tool, switched on; also where the ball is."""
    cell, kinematics = cell_of("arm7")
    centre = kinematics.tool_pose(cell.start)[1] + np.array(away)
    ball = Obstacle("ball", (Solid(Sphere(RADIUS)),), Placement(tuple(centre.tolist())), margin, margin + 0.2)
    setup = PacingSetup(
        kinematics, cell.limits, np.ones(7), cell.start, DT, planned_share=1.0 - CORRECTION_SHARE,
        scene=Scene({"ball": ball}),
    )  # fmt: skip
    pacer = Pacer(setup, lambda origin: PLACE)
    pacer.execute(ObstacleBlock(id=1, origin=Origin("t.irl", 0, 4, 1), name="ball", active=True))
    return pacer, centre


def least_distance(pacer: Pacer, q: np.ndarray) -> float:
    distances = pacer.clearance.distances
    return float(np.min(distances.near(q, np.full(len(distances.pairs), 9.0)).distance))


def test_questions_and_answers() -> None:
    nearness = Nearness()
    nearness.asked(2)
    nearness.asked(0)
    assert nearness.report == ObstacleReport(ticks=2, placements=2)
    assert nearness.warnings == []


def test_without_obstacles_or_far_from_them_nothing_is_near() -> None:
    nearness = Nearness()
    pacer, _ = pacer_beside((5.0, 0.0, 0.0))
    assert nearness.ended(None, pacer.q, 4, PLACE) is None
    assert nearness.ended(pacer.clearance, pacer.q, 4, PLACE) is None
    assert nearness.report == ObstacleReport()


def test_the_pair_with_the_least_room_is_given_and_counted_where_it_is_inside() -> None:
    """The margin grows from less than there is to more than there is: then it is told, each pair once."""
    told = []
    for margin in (0.001, 0.15):
        nearness = Nearness()
        pacer, _ = pacer_beside(BESIDE, margin)
        for tick in (4, 5):
            pair = nearness.ended(pacer.clearance, pacer.q, tick, PLACE)
            assert pair is not None
            assert (pair.other, pair.margin, pair.tick) == ("ball", margin, tick)
            distances = pacer.clearance.distances.near(
                pacer.q, np.full(len(pacer.clearance.distances.pairs), 9.0)
            )
            assert pair.distance == pytest.approx(np.min(distances.distance), abs=1e-9)
        told.append(nearness)
    outside, inside = told
    assert outside.report == ObstacleReport()
    assert outside.warnings == []
    assert inside.report.near_ticks == 2
    assert inside.report.nearest
    assert all(pair.distance < pair.margin and pair.tick == 4 for pair in inside.report.nearest)
    assert [warning.code for warning in inside.warnings] == ["IRL587"] * len(inside.report.nearest)


def test_a_pair_on_its_margin_is_not_inside() -> None:
    """A margin of just what there is, and of what is beyond rounding more."""
    found = []
    pacer, _ = pacer_beside(BESIDE)
    there = least_distance(pacer, pacer.q)
    for more in (0.0, 1e-4):
        nearness = Nearness()
        pacer, _ = pacer_beside(BESIDE, there + more)
        assert nearness.ended(pacer.clearance, pacer.q, 4, PLACE) is not None
        found.append(nearness.report.near_ticks)
    assert found == [0, 1]


def test_a_correction_goes_as_far_as_an_obstacle_lets_it() -> None:
    """The tool is sent into a ball: it ends short of that, and nothing comes inside the margin."""
    pacer, centre = pacer_beside((0.12, 0.0, 0.0))
    start, kinematics = pacer.q, pacer.setup.kinematics
    rotation, position = kinematics.tool_pose(start)
    ahead = np.concatenate([rotation.T @ np.array([0.2, 0.0, 0.0]), np.zeros(3)])
    goal = PoseTarget(tuple((position + np.array([0.0, 0.014, 0.0])).tolist()), None)
    move = MoveBlock(
        id=2,
        origin=Origin("t.irl", 0, 4, 2),
        kind=MoveKind.LIN,
        target=goal,
        law=MotionLaw(speed=0.015, acc=1.0, speed_ori=1.0, acc_ori=4.0),
    )
    names = tuple(axis.name for axis in kinematics.description.axes)
    rates = ToolRates(0.4, 2.0, 0.3, 1.5)
    corrector = Corrector(pacer, rates, Senses(lambda: ahead), Tally(names), Nearness())
    rows = list(corrector.rows([Executed(move, pacer.tick, pacer.execute(move))]))
    assert len(rows) >= 15
    gone = rows[-1].position[0] - position[0]
    assert 0.02 < gone < 0.12 - RADIUS - MARGIN + 1e-6
    for row in rows:
        assert np.linalg.norm(row.position - centre) > RADIUS
        assert least_distance(pacer, row.q) >= MARGIN - 2e-6
        assert row.nearest is None or row.nearest.distance >= MARGIN - 2e-6
    assert rows[-1].nearest is not None
    assert corrector.nearness.report.near_ticks == 0
    assert corrector.tally.report.refused_ticks > 0
    assert corrector.tally.report.position_lag is not None
