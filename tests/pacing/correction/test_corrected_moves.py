"""Corrected moves of a gantry on a rail: what the joints add to the plan is closed form."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import FreezeBlock, MotionLaw, MoveBlock, MoveKind, Origin, PoseTarget
from irlx.diagnostics import Place
from irlx.pacing.correction.corrector import CorrectedRow, Corrector, Senses
from irlx.pacing.correction.nearness import Nearness
from irlx.pacing.correction.report import CorrectionReport
from irlx.pacing.correction.share import CORRECTION_SHARE
from irlx.pacing.correction.tally import Tally
from irlx.pacing.correction.tool_rates import ToolRates
from irlx.pacing.errors import PacingError
from irlx.pacing.executed import Executed
from irlx.pacing.pacer import Pacer
from irlx.pacing.situation import PacingSetup
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits

DT = 0.02
WEIGHTS = np.array([3.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0])
LAW = MotionLaw(speed=0.2, acc=1.0, speed_ori=1.0, acc_ori=4.0)
RATES = ToolRates(0.1, 0.5, 0.3, 1.5)


class Line:
    """A line by `way` m and a wait in which it may settle, corrected by what `sensor` says of each row."""

    def __init__(
        self, kit, sensor: Callable | None, limits: JointLimits, way=(0.2, 0.1, 0.0), frozen=()
    ) -> None:
        kinematics = Kinematics(kit.gantry())
        setup = PacingSetup(
            kinematics, limits, WEIGHTS, kit.start.copy(), DT, planned_share=1.0 - CORRECTION_SHARE
        )
        self.limits, self.frozen, self.kit = limits, frozen, kit
        goal, back = kit.beyond(*way), kit.beyond(0.0, 0.0, 0.0)
        self.blocks = [
            MoveBlock(
                id=number,
                origin=Origin("t.irl", 0, 4, number),
                kind=MoveKind.LIN,
                target=PoseTarget(tuple(point.tolist()), None),
                law=LAW,
            )
            for number, point in enumerate((goal, back), start=2)
        ]
        self.planned = self._planned(Pacer(setup, lambda _: Place("t.irl")))
        pacer = Pacer(setup, lambda origin: Place("t.irl"))
        names = tuple(axis.name for axis in kinematics.description.axes)
        self.seen: list[CorrectedRow] = []
        ask = None if sensor is None else lambda: sensor(len(self.seen))
        corrector = Corrector(pacer, RATES, Senses(ask), Tally(names), Nearness())
        for row in corrector.rows(self._executed(pacer)):
            self.seen.append(row)
        self.report: CorrectionReport = corrector.tally.report
        self.q = np.array([row.q for row in self.seen])
        self.correction = np.array([row.correction for row in self.seen])
        self.offset = self.q[: len(self.planned)] - self.planned[: len(self.q)]

    def _executed(self, pacer: Pacer):
        if self.frozen:
            pacer.execute(FreezeBlock(id=1, origin=Origin("t.irl", 0, 4, 1), joints=self.frozen))
        for block in self.blocks:
            tick = pacer.tick
            yield Executed(block, tick, pacer.execute(block))

    def _planned(self, pacer: Pacer) -> np.ndarray:
        return np.concatenate([part.rows.q for part in self._executed(pacer)])

    def check(self) -> None:
        """Limits by differences from rest, and the pose of each row that goes with a planned one."""
        q = np.vstack([self.kit.start, self.kit.start, self.q])
        speeds = np.diff(q, axis=0) / DT
        for values, kind in (
            (q, "position"),
            (speeds, "speed"),
            (np.diff(speeds, axis=0) / DT, "acceleration"),
        ):
            lower, upper = self.limits.pair(kind)
            assert np.all(values <= upper + 1e-9), kind
            assert np.all(values >= lower - 1e-9), kind
        assert np.all(np.abs(speeds[-1]) < 1e-12)
        for row, planned in zip(self.seen, self.planned, strict=False):
            rotation = self.kit.rotation(planned)
            wanted = self.kit.position(planned) + rotation.apply(row.correction[:3])
            np.testing.assert_allclose(self.kit.position(row.q), wanted, rtol=0, atol=1e-9)
            turned = rotation * Rotation.from_rotvec(row.correction[3:])
            assert (turned.inv() * self.kit.rotation(row.q)).magnitude() < 1e-9
            np.testing.assert_allclose(row.position, wanted, rtol=0, atol=1e-9)


@pytest.fixture
def limits(kit) -> JointLimits:
    return kit.limits(position=5.0, speed=2.0, acceleration=8.0)


REQUEST = np.array([0.02, -0.01, 0.03, 0.05, -0.1, 0.04])


def test_a_sensor_that_says_nothing_changes_no_bit(kit, limits) -> None:
    line = Line(kit, lambda tick: None, limits)
    np.testing.assert_array_equal(line.q, line.planned)
    assert line.report == CorrectionReport(ticks=len(line.planned))


def test_nobody_who_corrects_changes_no_bit(kit, limits) -> None:
    line = Line(kit, None, limits)
    np.testing.assert_array_equal(line.q, line.planned)
    assert line.report == CorrectionReport()


@pytest.mark.parametrize(("frozen", "share"), [((), 0.25), ((2,), 1.0), ((1,), 0.0)])
def test_a_correction_is_reached_to_the_bit_and_shared_by_weights(kit, limits, frozen, share: float) -> None:
    """Rail and slide move along the same axis: three times the weight, a third of the way."""
    line = Line(kit, lambda tick: REQUEST, limits, frozen=frozen)
    line.check()
    assert len(line.q) == len(line.planned)
    np.testing.assert_array_equal(line.correction[-1], REQUEST)
    assert line.report.requests == line.report.ticks == len(line.q)
    assert line.report.refused_ticks == line.report.held_ticks == 0
    assert 0 < line.report.delayed_ticks < len(line.q)
    along = kit.rotation(line.planned[-1]).apply(REQUEST[:3])[0]
    assert line.offset[-1, 0] == pytest.approx(share * along, abs=1e-8)
    assert line.offset[-1, 1] == pytest.approx((1.0 - share) * along, abs=1e-8)
    for joint in frozen:
        assert not np.any(line.offset[:, joint - 1])


def test_a_correction_ends_as_it_came(kit, limits) -> None:
    """Asked for nothing again, the joints are on the planned rows again, to the last bit."""
    line = Line(kit, lambda tick: REQUEST if tick < 50 else np.zeros(6), limits)
    line.check()
    assert np.max(np.abs(line.offset)) > 0.01
    np.testing.assert_array_equal(line.q[-5:], line.planned[-5:])


def test_what_moves_at_the_end_comes_to_rest(kit, limits) -> None:
    """The request goes on growing: ticks are added in which the offset brakes."""
    line = Line(kit, lambda tick: 1.6e-3 * tick * np.eye(6)[1], limits)
    line.check()
    assert line.report.held_ticks == len(line.q) - len(line.planned) > 0
    assert line.seen[-1].block is line.blocks[-1]


def test_it_stops_at_a_position_limit_and_says_so(kit) -> None:
    """The y slide begins at -0.2 and may go to -0.05; the request would lead it on."""
    upper = np.array([5.0, 5.0, -0.05, 5.0, 5.0, 5.0, 5.0])
    ranges = [side for half in (5.0, 2.0, 8.0) for side in kit.pair(half)]
    ranges[1] = upper
    line = Line(kit, lambda tick: 1.6e-3 * tick * np.eye(6)[1], JointLimits(*ranges), way=(0.2, 0.0, 0.0))
    line.check()
    assert np.max(line.q[:, 2]) == pytest.approx(-0.05, abs=2e-3)
    assert line.report.refused_ticks > 0
    assert line.report.position_lag.joint == "y"
    assert line.report.position_lag.bound in {"position", "braking"}


def test_an_offset_goes_back_before_a_motion_that_has_no_room_for_it(kit) -> None:
    """The line goes up to the limit: what the correction added there has to be gone before it begins."""
    upper = np.array([5.0, 5.0, -0.08, 5.0, 5.0, 5.0, 5.0])
    ranges = [side for half in (5.0, 2.0, 8.0) for side in kit.pair(half)]
    ranges[1] = upper
    line = Line(kit, lambda tick: 0.06 * np.eye(6)[1], JointLimits(*ranges), way=(0.2, 0.1, 0.0))
    q = np.vstack([kit.start, line.q])
    speeds = np.diff(q, axis=0) / DT
    assert np.all(q <= upper)
    assert np.max(np.abs(speeds)) <= 2.0 + 1e-9
    assert np.max(np.abs(np.diff(speeds, axis=0))) <= 8.0 * DT + 1e-9
    assert line.report.held_ticks == len(line.q) - len(line.planned)


def test_an_answer_that_is_none_names_its_tick_and_the_robot_rests(kit, limits) -> None:
    with pytest.raises(PacingError) as caught:
        Line(kit, lambda tick: REQUEST if tick < 40 else "far", limits)
    assert (caught.value.reason.code, caught.value.reason.data["tick"]) == ("IRL580", 41)
