"""The posture to begin with: inside the limits, well away from singular ones, always the same."""

from dataclasses import replace
from importlib.resources import files

import numpy as np
import pytest

from irlx.robot.description import Joint, JointKind, RobotDescription
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.robot.urdf import read_urdf
from irlx.transform.open_posture import _openness, open_posture
from long_run import first_rows

ROBOTS = files("irlx.cell") / "robots"


def arm(name, tip="tool"):
    robot = read_urdf((ROBOTS / f"{name}.urdf").read_text(encoding="utf-8"), tip)
    lower, upper = (np.array([getattr(j, side) for j in robot.axes]) for side in ("lower", "upper"))
    return robot, JointLimits.unlimited(len(lower)).with_pair("position", lower, upper)


def two_links(first, second):
    """A planar arm of two links, its task the position of the tip."""
    z = (0.0, 0.0, 1.0)
    joints = (
        Joint("a", JointKind.REVOLUTE, "base", "one", axis=z),
        Joint("b", JointKind.REVOLUTE, "one", "two", xyz=(first, 0.0, 0.0), axis=z),
        Joint("end", JointKind.FIXED, "two", "tip", xyz=(second, 0.0, 0.0)),
    )
    return RobotDescription("two", "base", "tip", joints, coordinates=("x", "y"))


@pytest.mark.parametrize(
    ("name", "tip"), first_rows(2, [("arm7", "tool"), ("mobile8", "tool"), ("koch11", "tcp")])
)
def test_room_on_every_side(name, tip):
    robot, limits = arm(name, tip)
    kinematics = Kinematics(robot)
    q, measure = open_posture(kinematics, limits)
    lower, upper = limits.position_lower, limits.position_upper
    room = np.minimum(q - lower, upper - q) / (upper - lower)
    assert room.min() > 0.1
    assert measure > 0.05
    slides = np.array([joint.is_prismatic for joint in robot.axes])
    np.testing.assert_allclose(q[slides], 0.5 * (lower + upper)[slides], atol=1e-12)
    again, _ = open_posture(Kinematics(robot), limits)
    np.testing.assert_array_equal(q, again)


def test_two_links_against_every_elbow():
    """Closed form: the singular values of [[0, -l2 s], [.., ..]] over all elbow angles, on a fine grid."""
    robot = two_links(0.5, 0.4)
    kinematics = Kinematics(robot)
    limits = JointLimits.unlimited(2).with_pair("position", np.full(2, -3.0), np.full(2, 3.0))
    q, measure = open_posture(kinematics, limits)

    def least(elbow):
        # In the frame of the second link: J = [[l1 sin b, 0], [l1 cos b + l2, l2]].
        jacobian = np.array([[0.5 * np.sin(elbow), 0.0], [0.5 * np.cos(elbow) + 0.4, 0.4]])
        return np.linalg.svd(jacobian, compute_uv=False)[-1] / robot.reach

    best = max(
        least(b) * (1.0 - 0.3 * abs(b) / 6.0) * min(1.0, 0.5 * (1.0 - abs(b) / 3.0) / 0.2)
        for b in np.linspace(-3, 3, 2001)
    )
    assert 0.97 * best < measure <= best * (1 + 1e-6)
    assert abs(q[0]) < 0.2


def test_joints_without_limits_stay_within_half_a_turn():
    robot, _ = arm("arm7")
    q, measure = open_posture(Kinematics(robot), JointLimits.unlimited(7))
    assert np.abs(q).max() <= np.pi
    assert measure > 0.05


def test_one_open_side():
    robot, limits = arm("arm7")
    upper = limits.position_upper.copy()
    upper[1:4] = np.inf
    lower = limits.position_lower.copy()
    lower[3] = 0.5
    q, _ = open_posture(Kinematics(robot), limits.with_pair("position", lower, upper))
    assert np.all(q >= lower)


def test_nothing_to_find():
    """Joints that may not move keep their place; a task without rows has no measure."""
    robot, limits = arm("arm7")
    pinned = limits.with_pair("position", np.full(7, 0.3), np.full(7, 0.3))
    q, measure = open_posture(Kinematics(robot), pinned)
    np.testing.assert_allclose(q, 0.3)
    assert measure >= 0.0
    assert open_posture(Kinematics(replace(robot, coordinates=())), limits)[1] == 0.0


def test_the_elbow_of_an_arm_on_the_floor_is_not_below_it():
    robot, limits = arm("rail6")
    kinematics = Kinematics(robot)
    q, _ = open_posture(kinematics, limits)
    kinematics.tool_pose(q)
    assert min(float(frame.translation[2]) for frame in list(kinematics.data.oMi)[1:]) > -1e-9


@pytest.mark.parametrize(("first", "second"), [(0.1, -0.5), (0.02, 0.1), (0.05, 0.7), (1.2, 0.7)])
def test_a_tool_or_a_joint_below_the_foot_counts_less(first, second):
    """A tenth of the reach below it a half is left, far below a fifth; mirrored arms are alike."""
    y = (0.0, 1.0, 0.0)
    joints = tuple(replace(one, axis=y) for one in two_links(0.5, 0.4).joints)
    kinematics = Kinematics(RobotDescription("two", "base", "tip", joints, coordinates=("x", "z")))
    found, expected = [], []
    for side in (1.0, -1.0):
        elbow = -0.5 * np.sin(side * first)
        lowest = min(0.0, elbow, elbow - 0.4 * np.sin(side * (first + second)))
        found.append(_openness(kinematics, side * np.array([first, second])))
        expected.append(max(1.0 + 5.0 * lowest / 0.9, 0.2))
    assert expected[0] != expected[1]
    assert found[0] / found[1] == pytest.approx(expected[0] / expected[1], rel=1e-9)
