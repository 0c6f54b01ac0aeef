"""Gravity torque: the textbook pendulum, gradients, weights."""

import numpy as np
import pytest

from irlx.robot.description import Inertial, JointKind
from irlx.transform.measures.gravity_torque import GravityTorque

POINT = (0.0, 0.0, 0.0)


@pytest.mark.parametrize("q", [(0.0, 0.0), (0.3, -1.2), (2.0, np.pi / 2), (np.pi / 2, 0.0)])
@pytest.mark.parametrize("weights", [None, (0.2, 3.0)])
def test_double_pendulum(pendulum, q, weights):
    q, weights = np.array(q), None if weights is None else np.array(weights)
    measure = GravityTorque(pendulum.robot.kinematics, weights)
    weighted = pendulum.torque(q) * (1.0 if weights is None else weights)
    assert measure.value(q) == pytest.approx(0.5 * weighted @ pendulum.torque(q), rel=1e-13, abs=1e-13)
    expected = weighted @ pendulum.torque_derivative(q)
    assert np.allclose(measure.gradient(q), expected, rtol=1e-12, atol=1e-12)


def test_a_lift_holds_the_weight_of_all_above(make):
    body = Inertial(4.0, POINT, POINT, (1.0, 0.0, 0.0, 1.0, 0.0, 1.0))
    lift = (JointKind.PRISMATIC, POINT, (0.0, 0.0, 1.0))
    slide = (JointKind.PRISMATIC, POINT, (1.0, 0.0, 0.0))
    measure = GravityTorque(make.chain_of(lift, slide, masses={0: body, 1: body}).kinematics)
    q = np.array([0.3, -0.2])
    assert measure.value(q) == pytest.approx(0.5 * (8.0 * 9.81) ** 2, rel=1e-14)
    assert np.array_equal(measure.gradient(q), np.zeros(2))


def test_gradient(robot, make):
    rng = np.random.default_rng(robot.n)
    for weights in (None, rng.uniform(0.1, 2.0, robot.n)):
        measure = GravityTorque(robot.kinematics, weights)
        for q in [np.zeros(robot.n), robot.start, *robot.postures(7, 4)]:
            expected = make.derivative(measure.value, q)
            scale = max(np.abs(expected).max(), 1e-3 * measure.value(q))
            assert np.abs(measure.gradient(q) - expected).max() <= 1e-6 * scale


def test_upright_is_better_than_stretched_out(pendulum):
    measure = GravityTorque(pendulum.robot.kinematics)
    upright, stretched = np.array([np.pi / 2, 0.0]), np.zeros(2)
    assert measure.sense * (measure.value(stretched) - measure.value(upright)) > 0.0


@pytest.mark.parametrize("weights", [np.ones(3), np.array([1.0, -1.0]), np.array([1.0, np.nan])])
def test_wrong_weights(pendulum, weights):
    with pytest.raises(ValueError, match="one weight of at least 0 for each joint"):
        GravityTorque(pendulum.robot.kinematics, weights)
