"""Targets of a robot of five axes: the turn that its task leaves out is that of the target, or it is none."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.diagnostics import Place
from irlx.pacing.demand import Demands
from irlx.pacing.errors import PacingError
from irlx.pacing.left_out import AskedPose, check_on_path
from irlx.robot.description import RobotDescription
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits

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
