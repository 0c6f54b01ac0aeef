"""Where bounds have bent a corrected posture, it is drawn back no faster than it can stop there."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.pacing.correction.corrected_tick import Corrected, Surroundings, _criterion, uncorrected
from irlx.pacing.correction.offset_limiter import OffsetLimiter
from irlx.pacing.correction.plan import PlannedRow
from irlx.pacing.correction.tool_rates import ToolRates
from irlx.robot.limits import JointLimits
from irlx.transform.qp.dual import DualSolver
from irlx.transform.step_bounds import braking_speed
from irlx.transform.tick import TickSolver
from machines import machine

DT = 0.01


def around(speed: tuple[float, float], acceleration: float) -> Surroundings:
    robot = machine("arm7")
    sides = ((-9.0, 9.0), speed, (-acceleration, acceleration))
    limits = JointLimits(*(np.full(7, side) for pair in sides for side in pair))
    solver, free = TickSolver(robot.kinematics, DualSolver()), np.ones(7, dtype=bool)
    return Surroundings(solver, robot.weights, free, OffsetLimiter(limits, DT), ToolRates(0.4, 2.0, 0.3, 1.5))


def swung(length: float) -> tuple[PlannedRow, Corrected]:
    """An arm that has swung aside by so many rad in all, its tool where it is planned."""
    robot = machine("arm7")
    kinematics, start = robot.kinematics, robot.start
    rotation, position = kinematics.tool_pose(start)
    row = PlannedRow(start, rotation, position, start, start, None)
    q = start.copy()
    for _ in range(20):
        _, jacobian = kinematics.difference(q, kinematics.target(rotation, position))
        way = np.linalg.svd(jacobian)[2][-1]
        q = q + length / 20.0 * way * np.sign(way[0])
    return row, Corrected(row, q, np.zeros(7), np.zeros(6), np.zeros(6), bent=True)


@pytest.mark.parametrize(
    ("speed", "acceleration"), [((-0.1, 0.2), 50.0), ((-0.2, 0.1), 50.0), ((-2.0, 2.0), 0.3)]
)
def test_it_is_drawn_back_as_fast_as_its_joints_may_go_and_can_stop(speed, acceleration: float) -> None:
    row, before = swung(0.3)
    criterion = _criterion(before, row, np.zeros(6), around(speed, acceleration))
    step, left = criterion.reference - before.q, row.q - before.q
    # It goes straight to the planned posture, the nearest one on the pose.
    np.testing.assert_allclose(step / np.linalg.norm(step), left / np.linalg.norm(left), rtol=0, atol=1e-3)
    stopping = braking_speed(np.abs(left), np.full(7, 0.8 * acceleration), DT)
    most = np.minimum(stopping, np.where(left > 0.0, speed[1], -speed[0])) * DT
    # The elbow has to stay.
    moving = np.abs(left) > 1e-6
    assert np.max(np.abs(step)[moving] / most[moving]) == pytest.approx(1.0, rel=1e-2)


def test_near_by_it_is_the_planned_posture_itself() -> None:
    """So near that every joint may go there at once: no bit is left of what had bent it."""
    row, before = swung(1e-6)
    assert _criterion(before, row, np.zeros(6), around((-1.0, 1.0), 50.0)).reference is row.q
    row, _ = swung(0.3)
    assert _criterion(uncorrected(row), row, np.zeros(6), around((-0.1, 0.1), 0.3)).reference is row.q
