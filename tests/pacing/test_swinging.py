"""What counts as joints that swing."""

import numpy as np
import pytest

from irlx.pacing.swinging import swings
from irlx.robot.limits import JointLimits

DT = 0.01
TIME = np.linspace(0.0, 1.0, 101)[:, None]
SMOOTH = 0.5 * TIME**3 * (10.0 - 15.0 * TIME + 6.0 * TIME**2)


def limits(joints=1):
    ones = np.ones(joints)
    return JointLimits(-3.0 * ones, 3.0 * ones, -2.0 * ones, 2.0 * ones, -10.0 * ones, 10.0 * ones)


def swung(amplitude, turns):
    """A sine wave over the middle of the motion that turns the acceleration round so many times."""
    inside = (TIME > 0.25) & (TIME < 0.75)
    return SMOOTH + np.where(inside, amplitude * np.sin(2.0 * np.pi * (TIME - 0.25) * turns), 0.0)


def test_a_motion_from_rest_to_rest_does_not():
    assert not swings(SMOOTH, limits(), DT)
    assert not swings(np.zeros((50, 1)), limits(), DT)
    assert not swings(np.zeros((1, 1)), limits(), DT)


@pytest.mark.parametrize(("turns", "told"), [(6, False), (10, False), (20, True)])
def test_many_turns_of_the_acceleration_do(turns, told):
    assert swings(swung(4e-3, turns), limits(), DT) is told


@pytest.mark.parametrize(("ticks", "told"), [(3, False), (4, False), (7, True), (30, True)])
def test_ticks_to_and_fro_do(ticks, told):
    # A posture that stands aside in every second tick: k of these are 2 k + 1 accelerations in turn.
    q = SMOOTH.copy()
    q[40 : 40 + 2 * (ticks // 2) : 2] += 0.01
    assert swings(q, limits(), DT) is told


def test_joints_without_limits_swing_too():
    assert swings(swung(4e-3, 20), JointLimits.unlimited(1), DT)
    assert not swings(SMOOTH, JointLimits.unlimited(1), DT)
    assert not swings(1e-9 * (np.arange(101)[:, None] % 2), JointLimits.unlimited(1), DT)


def test_one_joint_is_enough():
    assert swings(np.hstack([SMOOTH, swung(4e-3, 20), SMOOTH]), limits(3), DT)


def test_noise_is_none():
    noise = 1e-9 * (np.arange(101)[:, None] % 2)
    assert not swings(SMOOTH + noise, limits(), DT)
    # Alone it is no motion either: a joint that stands.
    assert not swings(noise, limits(), DT)
