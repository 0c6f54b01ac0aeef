"""Targets of a robot of five axes: the turn that its task leaves out is that of the target, or it is none."""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.diagnostics import Place
from irlx.pacing.demand import Demands
from irlx.pacing.errors import PacingError
from irlx.pacing.left_out import AskedPose, check_on_path, check_points
from irlx.robot.description import RobotDescription
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.transform.qp.dual import DualSolver

PLACE = Place("t.irl")
ROWS = 9


@dataclass
class Turning:
    """A gantry without its last turn: it stands and turns about z and y; left out are turns about x."""

    kinematics: Kinematics
    q: np.ndarray
    demands: Demands

    def pose(self, row: int, extra: float = 0.0, away: float = 0.0) -> AskedPose:
        """That of a row, turned on by so much about the tool's x axis, and so far off along y."""
        rotation = self.demands.rotation[row] @ Rotation.from_rotvec([extra, 0.0, 0.0]).as_matrix()
        return AskedPose(rotation, self.demands.position[row] + np.array([0.0, away, 0.0]), PLACE)

    def limits(self, room: float = 5.0) -> JointLimits:
        half, free = np.full(6, room), np.full(6, np.inf)
        return JointLimits(-half, half, -free, free, -free, free)

    def check(self, pose: AskedPose, free: bool = True, room: float = 5.0) -> None:
        joints = np.full(6, free)
        check_on_path([pose], self.q, self.demands, (self.kinematics, self.limits(room), joints))


@pytest.fixture
def turning(kit) -> Turning:
    whole = kit.gantry()
    joints = whole.joints[:-1]
    robot = RobotDescription("five", "l0", joints[-1].child, joints, coordinates=("x", "y", "z", "ry", "rz"))
    kinematics = Kinematics(robot)
    start, end = np.array([0.0, 0.5, -0.2, 0.3, 0.1, -0.2]), np.array([0.0, 0.5, -0.2, 0.3, 0.9, -0.6])
    q = start + np.linspace(0.0, 1.0, ROWS)[:, None] * (end - start)
    rotation, position = kinematics.tool_poses(q)
    ticks = np.arange(1, ROWS + 1)
    demands = Demands(ticks, np.linspace(0.0, 1.0, ROWS), position, rotation, np.zeros((ROWS, 6)))
    return Turning(kinematics, q, demands)


def test_its_task_leaves_a_turn_that_follows(turning) -> None:
    assert turning.kinematics.following.coordinates == ("rx",)


@pytest.mark.parametrize("free", [True, False])
@pytest.mark.parametrize("row", [0, 4, ROWS - 1])
def test_a_target_that_a_row_meets_in_all_is_met(turning, row: int, free: bool) -> None:
    turning.check(turning.pose(row), free)


@pytest.mark.parametrize("row", [0, 4, ROWS - 1])
def test_a_row_that_is_turned_about_what_the_task_leaves_out(turning, row: int) -> None:
    """The row was asked for the pose itself: then that row is judged, whatever joints could do about it."""
    pose = turning.pose(row, extra=0.1)
    turning.demands.rotation[row] = pose.rotation
    with pytest.raises(PacingError) as caught:
        turning.check(pose, free=False)
    reason = caught.value.reason
    assert reason.code == "IRL437"
    assert f"{np.degrees(0.1):.6g} deg about x" in reason.data["off"].replace("-", "")


def test_a_target_between_rows_is_led_on_to(turning) -> None:
    rows = turning.kinematics.tool_pose(0.5 * (turning.q[3] + turning.q[4]))
    turning.check(AskedPose(*rows, PLACE))
    off = rows[0] @ Rotation.from_rotvec([0.1, 0.0, 0.0]).as_matrix()
    with pytest.raises(PacingError) as caught:
        turning.check(AskedPose(off, rows[1], PLACE))
    assert caught.value.reason.code == "IRL437"


def test_nothing_follows_where_the_joints_cannot_go(turning) -> None:
    """A target beside a rounded corner, beyond the position limits: whoever passes it owes no turn there."""
    turning.check(turning.pose(4, extra=0.1, away=1.5), room=1.0)


def check_all(turning, *poses: AskedPose) -> None:
    """Points of a PATH, sought from the first row on, joints up to 5 rad or m."""
    setup, free = SimpleNamespace(weights=np.ones(6)), np.ones(6, dtype=bool)
    situation = SimpleNamespace(
        kinematics=turning.kinematics, setup=setup, free=free, q=turning.q[0], qp=DualSolver()
    )
    check_points(poses, situation, turning.limits())


def test_points_that_postures_meet_in_all_are_met(turning) -> None:
    check_all(turning, turning.pose(2), turning.pose(ROWS - 1))


def test_a_point_that_no_posture_meets_in_all(turning) -> None:
    """What leads to it from the one before meets the task alone, and so does all else."""
    with pytest.raises(PacingError) as caught:
        check_all(turning, turning.pose(2), turning.pose(4, extra=0.1))
    reason = caught.value.reason
    assert reason.code == "IRL437"
    assert f"{np.degrees(0.1):.6g} deg about x" in reason.data["off"].replace("-", "")


def test_a_point_that_is_out_of_reach_is_passed_over(turning, monkeypatch) -> None:
    """The next one is met all the same. Others say what cannot be reached."""
    monkeypatch.setattr("irlx.transform.posture_search.RESTARTS", 1)
    check_all(turning, turning.pose(2, away=30.0), turning.pose(4))
