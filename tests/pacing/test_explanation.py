"""What is told of a tick, on a gantry: steps, bounds, the path and the problem are closed form."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import WaitBlock
from irlx.pacing.explanation import TickExplanation, explain_tick
from irlx.pacing.freed import Freed
from irlx.robot.kinematics import Kinematics

DT = 0.01
WEIGHTS = np.array([3.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0])
SPEED, ACC = 0.9, 6.0


def explained(shop, kit, rows, row: int) -> TickExplanation:
    before = np.vstack([kit.start, kit.start, rows.q])[row : row + 2]
    return explain_tick(
        rows, before, rows.first_tick + row, shop.limits, WEIGHTS, Kinematics(kit.gantry()), DT
    )


@pytest.fixture
def line(kit):
    """A shop and the rows of a line of 0.3 m in y and 0.4 m in z, slower than its joints."""
    shop = type(kit.shop())(kit.limits(5.0, SPEED, ACC), DT)
    return shop, shop.line(kit.beyond(0.0, 0.3, 0.4), clauses=())


def test_steps_and_their_bounds(kit, line) -> None:
    """From the speed of the row before, the acceleration allows so much more and so much less."""
    shop, rows = line
    q = np.vstack([kit.start, kit.start, rows.q])
    for row in (0, 3, len(rows) // 2):
        found = explained(shop, kit, rows, row)
        assert (found.tick, found.line, found.motion) == (rows.first_tick + row, 1, "MOVE LIN")
        assert found.time == pytest.approx(found.tick * DT)
        assert found.way_of_pacing == "ordinary tick"
        assert [joint.name for joint in found.joints] == ["rail", "x", "y", "z", "a", "b", "c"]
        assert [joint.prismatic for joint in found.joints] == [True] * 4 + [False] * 3
        for number, joint in enumerate(found.joints):
            speed = (q[row + 1, number] - q[row, number]) / DT
            assert joint.value == q[row + 2, number]
            assert joint.step == pytest.approx(q[row + 2, number] - q[row + 1, number], abs=1e-15)
            upper, lower = min(SPEED, speed + ACC * DT), max(-SPEED, speed - ACC * DT)
            assert (joint.lower, joint.upper) == pytest.approx((DT * lower, DT * upper), abs=1e-8)
            assert (joint.lower_source, joint.upper_source) == ("acceleration", "acceleration")
            assert joint.held == ""


def test_what_the_path_asks_for(kit, line) -> None:
    shop, rows = line
    row = len(rows) // 2
    path = explained(shop, kit, rows, row).path
    assert path is not None
    gone = rows.tool_position[row] - kit.position(kit.start)
    assert path.length == pytest.approx(0.5)
    assert path.way == pytest.approx(np.linalg.norm(gone))
    assert not path.turns
    assert path.rate == pytest.approx(0.5)
    assert path.programmed_rate == pytest.approx(0.5)
    assert path.position == pytest.approx(tuple(rows.tool_position[row]))
    assert abs(np.dot(path.orientation, kit.rotation(kit.start).as_quat())) == pytest.approx(1.0)
    assert path.twist == pytest.approx((0.0, 0.3, 0.4, 0.0, 0.0, 0.0), abs=1e-12)


def test_a_turn_is_told_in_angles(kit) -> None:
    shop = kit.shop()
    turned = kit.rotation(kit.start) * Rotation.from_rotvec([0.0, 0.0, 0.6])
    rows = shop.line(kit.beyond(0.0, 0.0, 0.0), turned)
    path = explained(shop, kit, rows, len(rows) // 2).path
    assert path.turns
    assert path.length == pytest.approx(0.6)
    assert 0.25 < path.way < 0.35
    assert path.rate == pytest.approx(np.linalg.norm(path.twist[3:]))
    assert path.rate == pytest.approx(path.programmed_rate, rel=1e-9)


def test_the_problem_and_the_criterion(kit, line) -> None:
    """Slides move the tool along axes: J is known, and least motion is (3, 1, 1, ...) over the joints."""
    shop, rows = line
    row = len(rows) // 2
    found = explained(shop, kit, rows, row)
    problem = found.problem
    assert problem.joints == ("rail", "x", "y", "z", "a", "b", "c")
    assert problem.unknowns == 1
    jacobian = np.array(problem.jacobian)
    step = np.array([joint.step for joint in found.joints])
    np.testing.assert_allclose(jacobian @ step, problem.left, rtol=0, atol=1e-12)
    np.testing.assert_allclose(jacobian[:, 0], jacobian[:, 1], rtol=0, atol=1e-12)
    np.testing.assert_allclose(jacobian[:3, 1:4].T @ jacobian[:3, 1:4], np.eye(3), rtol=0, atol=1e-12)
    np.testing.assert_allclose(problem.hessian, WEIGHTS)
    np.testing.assert_allclose(problem.gradient, 0.0)
    assert problem.near == ()
    (value,) = found.criteria
    assert value.chosen
    assert value.value == pytest.approx(0.5 * step @ (WEIGHTS * step))
    assert max(found.path_error) < 1e-9
    assert found.to_plain()["motion"] == "MOVE LIN"


def test_what_is_no_path_has_no_problem(kit) -> None:
    shop = type(kit.shop())(kit.limits(5.0, SPEED, ACC), DT)
    rows = shop.to(kit.moved(0.2, 0.1, 0.0, 0.0, 0.0, 0.0, 0.3))
    found = explained(shop, kit, rows, 2)
    assert (found.motion, found.path, found.problem) == ("MOVE PTP", None, None)
    assert found.way_of_pacing == "row of a motion of the joints"
    (value,) = found.criteria
    assert not value.chosen
    step = np.array([joint.step for joint in found.joints])
    assert value.value == pytest.approx(0.5 * step @ (WEIGHTS * step))
    last = explained(shop, kit, rows, len(rows) - 1)
    assert last.way_of_pacing == "hold tick of a stop"
    assert not any(joint.step for joint in last.joints)


def test_a_robot_that_stands(kit) -> None:
    shop = kit.shop()
    rows = shop.execute(WaitBlock(**shop._data(), duration=0.05))
    found = explained(shop, kit, rows, 2)
    assert (found.motion, found.way_of_pacing) == ("WAIT", "the robot stands")
    assert found.path is None


def test_a_joint_that_cannot_follow_runs_at_its_bound(kit) -> None:
    """The z slide may do 0.2 m/s, the line asks for more: it is slowed, and the slide runs at its limit."""
    speed = np.full(7, np.inf)
    speed[3] = 0.2
    shop = type(kit.shop())(kit.limits(5.0, speed), DT)
    rows = shop.line(kit.beyond(0.0, 0.0, 0.3))
    found = explained(shop, kit, rows, len(rows) // 2)
    assert found.way_of_pacing == "row of a motion planned as a whole"
    assert found.joints[3].upper_source == "speed"
    assert found.joints[3].upper == pytest.approx(0.2 * DT, rel=1e-5)
    assert found.joints[3].step <= found.joints[3].upper
    assert found.joints[3].step == pytest.approx(0.2 * DT, rel=1e-2)
    assert found.path.rate == pytest.approx(0.2, rel=1e-2)
    assert found.path.programmed_rate == pytest.approx(0.5)


def test_the_last_row_of_a_line_holds_and_asks_for_nothing(kit, line) -> None:
    shop, rows = line
    assert rows.path is not None
    assert len(rows) == len(rows.path.demands) + 1
    found = explained(shop, kit, rows, len(rows) - 1)
    assert found.way_of_pacing == "hold tick of a stop"
    assert (found.path, found.problem) == (None, None)
    assert not any(joint.step for joint in found.joints)
    assert explained(shop, kit, rows, len(rows) - 2).path.way == pytest.approx(0.5, abs=1e-4)


def test_virtual_joints_that_are_none_change_nothing(kit, line) -> None:
    """A robot with no joints but its own among the virtual ones is explained as it is without them."""
    shop, rows = line
    kinematics = Kinematics(kit.gantry())
    q = np.vstack([kit.start, rows.q])
    freed = Freed(kinematics, kinematics, np.arange(7), shop.limits, WEIGHTS, q)
    wide = replace(rows, freed=freed)
    for row in (0, len(rows) // 2):
        assert explained(shop, kit, wide, row) == explained(shop, kit, rows, row)
