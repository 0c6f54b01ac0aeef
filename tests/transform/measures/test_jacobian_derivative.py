"""The derivative of the tool Jacobian: against differences, and by the order of the joints."""

import numpy as np
import pinocchio as pin
import pytest

from irlx.transform.measures.jacobian_derivative import jacobian_derivative
from irlx.transform.measures.scaled_jacobian import scaled_jacobian


def plain_jacobian(robot, q):
    return robot.kinematics.difference(q, pin.SE3.Identity())[1]


@pytest.mark.parametrize("jacobian", [plain_jacobian, lambda robot, q: scaled_jacobian(robot.kinematics, q)])
def test_is_the_limit_of_differences(robot, jacobian, make):
    for q in [np.zeros(robot.n), robot.start, *robot.postures(1, 3)]:
        found = jacobian_derivative(jacobian(robot, q), robot.kinematics.nearer_tool)
        assert found.shape == (6, robot.n, robot.n)
        expected = make.derivative(lambda q: jacobian(robot, q), q)
        assert np.abs(found - expected).max() <= 1e-9 * max(1.0, np.abs(expected).max())


def test_a_joint_does_not_change_its_own_axis_nor_those_behind_it(robot):
    found = jacobian_derivative(plain_jacobian(robot, robot.postures(2, 1)[0]), robot.kinematics.nearer_tool)
    rows, columns = np.tril_indices(robot.n)
    assert np.all(found[:, rows, columns] == 0.0)
    assert np.any(found != 0.0)


def test_two_turns_by_hand():
    """A turn about z 2 m aside, then one about x at the tool: (w_0 x v_1 + v_0 x w_1, w_0 x w_1)."""
    jacobian = np.array([[0.0, 2.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0, 0.0, 0.0]]).T
    expected = np.zeros((6, 2, 2))
    expected[:, 0, 1] = [0.0, 0.0, -2.0, 0.0, 1.0, 0.0]
    assert np.array_equal(jacobian_derivative(jacobian, np.triu(np.ones((2, 2)), 1)), expected)


def test_scaled_jacobian_has_the_singular_values_of_any_frame_at_the_tool(robot):
    for q in robot.postures(3, 2):
        found = np.linalg.svd(scaled_jacobian(robot.kinematics, q), compute_uv=False)
        assert np.abs(found - np.linalg.svd(robot.jacobian(q), compute_uv=False)).max() <= 1e-8
