"""The URDF reader and the model built from it, against Pinocchio's own reader on random trees."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation

from irlx.robot.kinematics import Kinematics
from irlx.robot.urdf import read_urdf

pytestmark = pytest.mark.req("TRF-20")


def built(robot) -> Kinematics:
    return Kinematics(read_urdf(robot.text, robot.tip, robot.locked))


def postures(robot, count: int = 6) -> list[np.ndarray]:
    """Random postures, the first one all zeros, the second with exact zeros and half turns mixed in."""
    rng = np.random.default_rng(7)
    n = len(robot.axes)
    special = rng.choice([0.0, np.pi, -np.pi / 2, 1e-16], size=n)
    return [np.zeros(n), special, *(rng.uniform(-3.0, 3.0, n) for _ in range(count - 2))]


def test_axes_are_the_moving_unlocked_joints_in_order(random_robot) -> None:
    kinematics = built(random_robot)
    assert kinematics.description.joint_names == tuple(random_robot.axes)
    assert kinematics.joints == len(random_robot.axes)


def test_continuous_joints_take_one_number_each(random_robot) -> None:
    model = built(random_robot).model
    assert model.nq == model.nv == len(random_robot.axes)
    assert list(model.names)[1:] == random_robot.axes


def test_tool_pose_equals_pinocchios(random_robot) -> None:
    kinematics = built(random_robot)
    for q in postures(random_robot):
        rotation, position = kinematics.tool_pose(q)
        want_rotation, want_position = random_robot.tool_pose(q)
        np.testing.assert_allclose(rotation, want_rotation, atol=1e-12, err_msg=f"q = {q!r}")
        np.testing.assert_allclose(position, want_position, atol=1e-11, err_msg=f"q = {q!r}")


def test_jacobian_equals_central_differences_of_pinocchios_pose(random_robot) -> None:
    kinematics = built(random_robot)
    h = 1e-6
    for q in postures(random_robot, 4):
        rotation, position = random_robot.tool_pose(q)
        _, jacobian = kinematics.difference(q, kinematics.target(rotation, position))
        for joint in range(q.size):
            step = np.zeros(q.size)
            step[joint] = h
            (r1, p1), (r0, p0) = random_robot.tool_pose(q + step), random_robot.tool_pose(q - step)
            linear = rotation.T @ (p1 - p0) / (2 * h)
            angular = Rotation.from_matrix(r0.T @ r1).as_rotvec() / (2 * h)
            # The axis of the turn between the two poses reads the same from both and from the middle.
            found = jacobian[:, joint]
            np.testing.assert_allclose(found[:3], linear, atol=2e-8, err_msg=f"joint {joint}, q = {q!r}")
            np.testing.assert_allclose(found[3:], angular, atol=2e-8, err_msg=f"joint {joint}, q = {q!r}")


def test_pose_difference_leads_to_the_target(random_robot) -> None:
    """Screwing the pose along the returned twist for unit time (own matrix exponential) meets the target."""
    from scipy.linalg import expm

    kinematics = built(random_robot)
    rng = np.random.default_rng(3)
    q = rng.uniform(-2.0, 2.0, len(random_robot.axes))
    turn, way = Rotation.from_rotvec(rng.uniform(-1.5, 1.5, 3)), rng.normal(size=3)
    rotation, position = random_robot.tool_pose(q)
    goal_rotation, goal_position = rotation @ turn.as_matrix(), position + way
    twist, _ = kinematics.difference(q, kinematics.target(goal_rotation, goal_position))
    wx, wy, wz = twist[3:]
    screw = np.zeros((4, 4))
    screw[:3, :3] = [[0, -wz, wy], [wz, 0, -wx], [-wy, wx, 0]]
    screw[:3, 3] = twist[:3]
    moved = expm(screw)
    np.testing.assert_allclose(rotation @ moved[:3, :3], goal_rotation, atol=1e-10)
    np.testing.assert_allclose(position + rotation @ moved[:3, 3], goal_position, atol=1e-10)


def test_masses_of_side_branches_and_locked_links_count(random_robot) -> None:
    """The joint-space inertia equals Pinocchio's with the held joints' rows struck out."""
    kinematics = built(random_robot)
    for q in postures(random_robot, 4):
        matrix = pin.crba(kinematics.model, kinematics.data, q)
        matrix = np.triu(matrix) + np.triu(matrix, 1).T
        wanted = random_robot.inertia(q)
        scale = max(1.0, float(np.max(np.abs(wanted), initial=0.0)))
        np.testing.assert_allclose(matrix, wanted, atol=1e-11 * scale, err_msg=f"q = {q!r}")


def test_buffers_do_not_leak_between_calls(random_robot) -> None:
    """A pose asked for after another one is that of its own posture."""
    kinematics = built(random_robot)
    first, second = postures(random_robot)[:2]
    kept = kinematics.tool_pose(first)
    copies = kept[0].copy(), kept[1].copy()
    kinematics.tool_pose(second)
    kinematics.difference(second, kinematics.target(*kept))
    np.testing.assert_array_equal(kept[0], copies[0])
    np.testing.assert_array_equal(kept[1], copies[1])


def test_derivative_of_the_pose_difference_equals_central_differences(random_robot) -> None:
    kinematics = built(random_robot)
    rng = np.random.default_rng(11)
    h = 1e-6
    for turn in (0.0, 1e-9, 0.7, 2.5):
        q = rng.uniform(-2.0, 2.0, len(random_robot.axes))
        rotation, position = random_robot.tool_pose(q)
        axis = rng.normal(size=3)
        rotation = rotation @ Rotation.from_rotvec(turn * axis / np.linalg.norm(axis)).as_matrix()
        target = kinematics.target(rotation, position + rng.normal(size=3) * min(turn, 1.0))
        _, derivative = kinematics.difference_derivative(q, target)
        derivative = derivative.copy()
        for joint in range(q.size):
            step = np.zeros(q.size)
            step[joint] = h
            after, before = (kinematics.difference(p, target)[0].copy() for p in (q + step, q - step))
            wanted = (after - before) / (2 * h)
            message = f"joint {joint}, turn {turn}, q = {q!r}"
            np.testing.assert_allclose(derivative[:, joint], wanted, atol=1e-6, err_msg=message)
