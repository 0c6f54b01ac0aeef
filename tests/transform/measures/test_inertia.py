"""The inertia matrix and its derivative: textbook pendulum, another algorithm, differences."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from irlx.robot.description import Inertial
from irlx.transform.measures.inertia import has_masses, inertia_derivative, inertia_matrix

POINT = (0.0, 0.0, 0.0)


@pytest.mark.parametrize("q", [(0.0, 0.0), (0.3, -1.2), (2.0, np.pi / 2)])
def test_double_pendulum(pendulum, q):
    q = np.array(q)
    found = inertia_matrix(pendulum.robot.kinematics, q)
    assert np.abs(found - pendulum.inertia(q)).max() <= 1e-14
    found = inertia_derivative(pendulum.robot.kinematics, q)
    assert np.abs(found - pendulum.inertia_derivative(q)).max() <= 1e-14


def test_columns_are_the_forces_of_unit_accelerations(robot):
    model, data, rest = robot.kinematics.model, robot.kinematics.data, np.zeros(robot.n)
    for q in [np.zeros(robot.n), *robot.postures(4, 2)]:
        found = inertia_matrix(robot.kinematics, q)
        weight = pin.rnea(model, data, q, rest, rest)
        columns = [pin.rnea(model, data, q, rest, unit) - weight for unit in np.eye(robot.n)]
        assert np.array_equal(found, found.T)
        assert np.linalg.eigvalsh(found)[0] > 0.0
        assert np.abs(found - np.array(columns).T).max() <= 1e-12 * np.abs(found).max()


def test_derivative_is_the_limit_of_differences(robot, make):
    for q in [np.zeros(robot.n), robot.start, *robot.postures(5, 3)]:
        found = inertia_derivative(robot.kinematics, q)
        assert found.shape == (robot.n,) * 3
        expected = make.derivative(lambda q: inertia_matrix(robot.kinematics, q), q)
        assert np.abs(found - expected).max() <= 1e-9 * np.abs(expected).max()
        assert np.array_equal(found, found.transpose(1, 0, 2))


def test_derivative_is_that_of_the_inverse_dynamics(robot):
    model, data, rest = robot.kinematics.model, robot.kinematics.data, np.zeros(robot.n)
    for q in robot.postures(6, 3):
        found = inertia_derivative(robot.kinematics, q)
        weight = np.array(pin.computeRNEADerivatives(model, data, q, rest, rest)[0])
        for joint, unit in enumerate(np.eye(robot.n)):
            column = pin.computeRNEADerivatives(model, data, q, rest, unit)[0] - weight
            assert np.abs(found[:, joint] - column).max() <= 1e-11 * np.abs(found).max()


def test_results_outlive_the_next_call(packaged):
    first = inertia_matrix(packaged.kinematics, packaged.start)
    kept = first.copy()
    inertia_matrix(packaged.kinematics, packaged.start + 0.3)
    assert np.array_equal(first, kept)


def test_packaged_robots_have_masses(packaged):
    assert has_masses(packaged.description)
    assert not has_masses(replace(packaged.description, inertials={}))


def test_masses_that_no_axis_moves_do_not_count(packaged):
    robot = packaged.description
    body = Inertial(5.0, POINT, POINT, (1.0, 0.0, 0.0, 1.0, 0.0, 1.0))
    assert not has_masses(replace(robot, inertials={robot.root: body}))
    assert not has_masses(replace(robot, inertials={robot.tip: replace(body, mass=0.0)}))
    assert has_masses(replace(robot, inertials={robot.tip: body}))


def test_a_mass_behind_locked_joints_only_does_not_count(packaged):
    robot = packaged.description
    first = robot.axes[0]
    body = Inertial(5.0, POINT, POINT, (1.0, 0.0, 0.0, 1.0, 0.0, 1.0))
    assert has_masses(replace(robot, inertials={first.child: body}))
    assert not has_masses(replace(robot, inertials={first.child: body}, locked={first.name: 0.2}))
