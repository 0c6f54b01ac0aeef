"""A correction from motion to motion: other tools, limits and frozen joints, and what is seen on the way."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import (
    Block,
    FreezeBlock,
    LimitKind,
    LimitSwitchBlock,
    MotionLaw,
    MoveBlock,
    MoveKind,
    Origin,
    PoseTarget,
    ToolBlock,
)
from irlx.diagnostics import Place
from irlx.pacing.correction.corrector import CorrectedRow, Corrector, Senses
from irlx.pacing.correction.nearness import Nearness
from irlx.pacing.correction.share import CORRECTION_SHARE
from irlx.pacing.correction.tally import Tally
from irlx.pacing.correction.tool_rates import ToolRates
from irlx.pacing.executed import Executed
from irlx.pacing.pacer import Pacer
from irlx.pacing.situation import PacingSetup
from irlx.robot.kinematics import Kinematics
from irlx.scene.obstacle import Obstacle
from irlx.scene.scene import Scene
from irlx.scene.sightings import Sightings
from irlx.solids.placement import Placement
from irlx.solids.shape import Solid, Sphere

DT = 0.02
LAW = MotionLaw(speed=0.2, acc=1.0, speed_ori=1.0, acc_ori=4.0)
RATES = ToolRates(0.1, 0.5, 0.3, 1.5)
REQUEST = np.array([0.02, -0.01, 0.03, 0.0, 0.0, 0.0])


class Corrected:
    """Blocks carried out on a gantry with a correction: rows, and where each block's planned rows are."""

    def __init__(
        self, kit, blocks: list[Block], ask: Callable[[], object] | None, look=None, scene=None
    ) -> None:
        kinematics = Kinematics(kit.gantry())
        limits = kit.limits(position=5.0, speed=2.0, acceleration=8.0)
        setup = PacingSetup(
            kinematics, limits, np.ones(7), kit.start.copy(), DT, planned_share=1.0 - CORRECTION_SHARE,
            scene=Scene() if scene is None else scene,
        )  # fmt: skip
        pacer = Pacer(setup, lambda origin: Place("t.irl"))
        names = tuple(axis.name for axis in kinematics.description.axes)
        self.corrector = Corrector(pacer, RATES, Senses(ask, look), Tally(names), Nearness())
        self.blocks, self.planned = blocks, list[np.ndarray]()
        self.rows: list[CorrectedRow] = list(self.corrector.rows(self._executed(pacer)))
        self.q = np.array([row.q for row in self.rows])

    def _executed(self, pacer: Pacer) -> Iterator[Executed]:
        for block in self.blocks:
            tick, rows = pacer.tick, pacer.execute(block)
            if rows is not None:
                self.planned.append(rows.q)
            yield Executed(block, tick, rows)

    def of(self, number: int) -> np.ndarray:
        return np.array([row.q for row in self.rows if row.block.id == number])


def origin(number: int) -> Origin:
    return Origin("t.irl", 0, 4, number)


def line(number: int, position: np.ndarray) -> MoveBlock:
    target = PoseTarget(tuple(position.tolist()), None)
    return MoveBlock(id=number, origin=origin(number), kind=MoveKind.LIN, target=target, law=LAW)


def there_and_back(kit, between: Block) -> list[Block]:
    return [line(1, kit.beyond(0.1, 0.0, 0.0)), between, line(3, kit.beyond(0.0, 0.0, 0.0))]


def test_a_new_tool_is_corrected_from_where_it_is(kit) -> None:
    """Its pose at the end is the planned one of that tool, moved by the correction in its own axes."""
    turn = Rotation.from_rotvec([0.0, 0.4, 0.0])
    tool = ToolBlock(id=2, origin=origin(2), position=(0.0, 0.0, 0.1), orientation=tuple(turn.as_quat()))
    goal = kit.beyond(0.0, 0.0, 0.05)
    found = Corrected(kit, [line(1, kit.beyond(0.1, 0.0, 0.0)), tool, line(3, goal)], lambda: REQUEST)
    last = found.rows[-1]
    np.testing.assert_array_equal(last.correction, REQUEST)
    wrist = kit.rotation(found.q[-1])
    at = kit.position(found.q[-1]) + wrist.apply([0.0, 0.0, 0.1])
    np.testing.assert_allclose(last.position, at, rtol=0, atol=1e-12)
    np.testing.assert_allclose(last.position, last.rotation @ REQUEST[:3] + goal, rtol=0, atol=1e-7)
    np.testing.assert_allclose((wrist * turn).as_matrix(), last.rotation, rtol=0, atol=1e-9)
    np.testing.assert_allclose(wrist.as_matrix(), kit.rotation(kit.start).as_matrix(), rtol=0, atol=1e-9)
    speeds = np.diff(np.vstack([kit.start, found.q]), axis=0) / DT
    assert np.max(np.abs(speeds)) <= 2.0


def test_an_offset_leaves_a_place_that_narrower_limits_forbid(kit) -> None:
    """The correction is 3 cm along the tool's z; then z may go no higher than 1 cm above the plan."""
    upper = np.full(7, 5.0)
    upper[3] = kit.start[3] + 0.01
    narrower = LimitSwitchBlock(id=2, origin=origin(2), kind=LimitKind.POSITION, range=kit.range(upper, -5.0))
    found = Corrected(kit, there_and_back(kit, narrower), lambda: REQUEST)
    assert np.max(found.of(1)[:, 3]) > upper[3] + 0.01
    assert np.all(found.of(3) <= upper)
    held = found.corrector.tally.report.held_ticks
    assert held == len(found.rows) - sum(map(len, found.planned)) > 0
    speeds = np.diff(np.vstack([kit.start, kit.start, found.q]), axis=0) / DT
    assert np.max(np.abs(speeds)) <= 2.0
    assert np.max(np.abs(np.diff(speeds, axis=0))) / DT <= 8.0 + 1e-9


@pytest.mark.parametrize("most", [0.0, 0.05])
def test_a_correction_stops_before_joints_brake_worse(kit, most: float) -> None:
    """The request goes to and fro; then two joints may hardly accelerate: they would go on for a metre."""
    limits = np.where(np.arange(7) == 2, most, 8.0)
    narrower = LimitSwitchBlock(
        id=2, origin=origin(2), kind=LimitKind.ACCELERATION, range=kit.range(limits, -limits)
    )
    count = iter(range(10_000))
    move = line(1, kit.beyond(0.1, 0.0, 0.0))
    back = line(3, kit.beyond(0.0, 0.0, 0.0))
    found = Corrected(kit, [move, narrower, back], lambda: 0.05 * np.sin(0.1 * next(count)) * np.eye(6)[1])
    speeds = np.diff(np.vstack([kit.start, kit.start, found.q]), axis=0) / DT
    accelerations = np.diff(speeds, axis=0) / DT
    first = len(found.of(1))
    assert np.max(np.abs(speeds[:first, 2])) > 0.05
    assert np.max(np.abs(accelerations[first:, 2])) <= most + 1e-9
    assert np.max(np.abs(found.of(3)[:, 2] - found.of(1)[-1, 2])) < 0.06
    assert not np.any(speeds[-1])


@pytest.mark.parametrize("joint", [1, 2])
def test_a_joint_that_is_frozen_under_way_comes_to_rest_first(kit, joint: int) -> None:
    """The request grows all the time: joints that move with it brake in ticks of their own, then stand."""
    freeze = FreezeBlock(id=2, origin=origin(2), joints=(joint,))
    count = iter(range(10_000))
    found = Corrected(kit, there_and_back(kit, freeze), lambda: 1e-3 * next(count) * np.eye(6)[0])
    back = found.of(3)
    assert np.all(back[:, joint - 1] == back[0, joint - 1])
    assert found.corrector.tally.report.held_ticks > 0
    speeds = np.diff(np.vstack([kit.start, kit.start, found.q]), axis=0) / DT
    assert np.max(np.abs(np.diff(speeds, axis=0))) / DT <= 8.0 + 1e-9


def test_what_is_seen_is_asked_for_once_a_tick_and_counted(kit) -> None:
    """For each row, and perhaps once more at the end."""
    asked = []

    def look() -> dict[str, tuple[float, float, float]] | None:
        asked.append(len(asked))
        return {"ball": (9.0, 9.0, 0.01 * len(asked))} if len(asked) % 2 else None

    ball = Obstacle("ball", (Solid(Sphere(0.05)),), Placement((9.0, 9.0, 0.0)), 0.01, 0.05)
    scene = Scene({"ball": ball}, sightings=Sightings())
    found = Corrected(kit, [line(1, kit.beyond(0.02, 0.0, 0.0))], None, look, scene)
    report = found.corrector.nearness.report
    assert report.ticks == len(asked)
    assert report.placements == (len(asked) + 1) // 2
    assert len(asked) - len(found.rows) in {0, 1}
    np.testing.assert_array_equal(found.q, found.planned[0])
